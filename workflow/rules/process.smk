"""Devices against roughness and process.

Above each rule: what it does, the rules whose results it reads -> the files that it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Contact of the patch of {device}, roughness {number}.
#   heights, spectrum -> results/devices/contact/roughness/{device}_{number}.nc
define("roughness_contact")

# Contact of the tips of {device}, roughness {number}.
#   heights, spectrum -> results/devices/contact/tips/roughness/{device}_{number}.nc
define("roughness_tip_contact")

# Contact of the patch, in dry air, of {device}, roughness {number}.
#   heights, spectrum -> results/devices/contact/roughness/{device}_dry_{number}.nc
define("roughness_dry_contact")

# Contact of the tips, in dry air, of {device}, roughness {number}.
#   heights, spectrum -> results/devices/contact/tips/roughness/{device}_dry_{number}.nc
define("roughness_dry_tip_contact")

# Device {device} at roughness {number}.
#   roughness_contact, roughness_dry_contact, roughness_tip_contact, roughness_dry_tip_contact,
#     pair_model_error_dry -> results/devices/roughness/points/{device}_{number}.nc
define("roughness_point")

# Roughness that device {device} needs.
#   roughness_point -> results/devices/roughness/{device}.nc
define("roughness")

# Device {device} over its process.
#   process_point, process_law -> results/process/curves/{device}.nc
define("process_curve")

# Device {device} over two processes.
#   process_point, process_law -> results/process/maps/{device}.nc
define("process_map")

# Law of process {process}.
#   no results -> results/process/laws/{process}.nc
define("process_law")

# Device {device} at value {number} of its process.
#   heights, spectrum, process_law -> results/process/points/{device}_{number}.nc
define("process_point")

# Recommended {variable}.
#   process_curve, process_law -> results/process/settings/{variable}.nc
define("process_settings")

# Recommended pairs of settings for {device}.
#   process_map, process_law -> results/process/pairs/{device}.nc
define("process_pairs")
