"""Surfaces beside the chain: scans, statistics, comparisons (Sec. II).

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Statistics of simulated {model} surfaces {surface} (Table I).
#   heights, spectrum -> results/character/{surface}_{model}.nc
define("character")

# Autocorrelation of the surfaces (App. C).
#   spectrum -> results/studies/correlation.nc
define("correlation")

# Estimate surface {surface} from its scans.
#   scan -> results/estimate/{surface}.nc
define("estimate")

# Iterative spectrum of {surface}, for comparison with the closed form (Fig. 4).
#   heights, spectrum -> results/iteration/{surface}.nc
define("iteration")

# Height density of measured surface {surface} (Sec. II-A).
#   estimate -> results/heights/{surface}.nc
define("heights_of_scans")

# Spectrum of measured surface {surface} and of the underlying Gaussian field (Sec. II-B).
#   estimate, heights -> results/spectrum/{surface}.nc
define("spectrum_of_scans")

# Read scan {number} of surface {surface}.
#   no results -> results/scan/{surface}_{number}.nc
define("scan")
