"""Devices against roughness and process.

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Law of process {process}.
#   no results -> results/process/laws/{process}.nc
define("process_law")

# Device {device} over its process.
#   process_point, process_law, device_model_error -> results/process/curves/{device}.nc
define("process_curve")

# Device {device} over two processes.
#   process_point, process_law, device_model_error -> results/process/maps/{device}.nc
define("process_map")

# Device {device} at value {number} of its process.
#   heights, spectrum, model_error_of_devices, process_law -> results/process/points/{device}_{number}.nc
define("process_point")

# Recommended {variable}.
#   process_curve, process_law -> results/process/settings/{variable}.nc
define("process_settings")

# Recommended pairs of settings for {device}.
#   process_map, process_law -> results/process/pairs/{device}.nc
define("process_pairs")

# Device {device} at roughness {number}.
#   heights, spectrum, model_error_of_devices -> results/devices/roughness/points/{device}_{number}.nc
define("roughness_point")

# Roughness that device {device} needs.
#   roughness_point -> results/devices/roughness/{device}.nc
define("roughness")
