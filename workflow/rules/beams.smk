"""Beams beside the chain: mesh, resampling, variants (Apps. B and C).

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Convergence of the crack length in the mesh of the beam (App. C).
#   forces -> results/studies/mesh.nc
define("mesh")

# Release the beams of {case} on force laws resampled from the contact samples (App. B).
#   forces -> results/studies/resampling/{case}.nc
define("resampling")

# Crack lengths of {case} under variant {variant}.
#   contact, variant_contact, variant_islands, pair_model_error, pair_model_error_across ->
#     results/studies/variants/{case}_{variant}.nc
define("variant")
