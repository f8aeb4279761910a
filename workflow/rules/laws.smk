"""Force laws beside the chain: fits, sensitivity, convergence (Sec. III-B, App. B).

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Errors of Eq. (12) in {case}, {model} (Sec. III-B1).
#   contact, forces -> results/fit/{case}_{model}.nc
define("fit")

# Adhesion energy of {model} surfaces of pair {pair} against relative humidity.
#   contact -> results/humidity/{pair}_{model}.nc
define("humidity")

# Convergence of the chaos model in the order of its polynomials (App. B).
#   forces, chaos -> results/studies/orders.nc
define("orders")

# Convergence of the adhesion energy in the number of samples (App. B).
#   forces -> results/studies/sample_sizes.nc
define("sample_sizes")

# Uncertainty of the adhesion of pair {pair} due to finite scans.
#   slopes, estimate, contact, choice_contact -> results/studies/scan_uncertainty/{pair}.nc
define("scan_uncertainty")

# Sensitivity of the adhesion of pair {pair} to {moment} (Fig. 13).
#   sensitivity_contact, contact -> results/studies/sensitivity/{pair}_{moment}.nc
define("sensitivity")

# Slopes of the adhesion of pair {pair} to the quantities of {surface}.
#   slope_contact -> results/studies/slopes/{pair}_{surface}.nc
define("slopes")
