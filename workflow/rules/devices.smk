"""Devices: safe lengths, stoppers, budgets, life, test beams.

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Budget of {case}.
#   heights, spectrum, contact, device_contact, model_error_of_devices, slope_contact, device_slope_contact,
#     solid_contact, device_choice_contact -> results/devices/budget/{case}.nc
define("budget")

# Budget of the tips of {case}.
#   heights, spectrum, tip_contact, tip_slope_contact, tip_solid_contact, tip_edge_contact, tip_choice_contact
#     -> results/devices/budget/{case}_tip.nc
define("tip_budget")

# Budget of test beams {case}.
#   heights, spectrum, contact, device_contact, model_error_of_devices, slope_contact, device_slope_contact,
#     solid_contact -> results/devices/test_beams/budget/{case}.nc
define("test_beam_budget")

# Budget of the tips of test beams {case}.
#   heights, spectrum, tip_contact, tip_slope_contact, tip_solid_contact ->
#     results/devices/test_beams/budget/{case}_tip.nc
define("test_beam_tip_budget")

# Chart of {case}.
#   ground, tip_contact, model_error_of_devices, chart -> results/devices/chart/{case}.nc
define("chart")

# Release long beams of {case}.
#   ground, sizes -> results/devices/cracks/{case}.nc
define("cracks")

# Release beams of a few sizes on {case}, strips of {length} x {width} nm.
#   ground -> results/devices/sizes/{case}_{length}x{width}.nc
define("sizes")

# Error of the model of the contact in the predictions of {device}.
#   model_error_of_devices, full_contact_dry, probe_in_full_contact -> results/devices/model_error/{device}.nc
define("device_model_error")

# Limits of the model that device {device} exceeds.
#   safe_lengths, plasticity, model_error_of_devices, model_error_of_probes, stoppers, chart, left_out_gaps ->
#     results/devices/warnings/{device}.json
define("device_warnings")

# Force laws of {case}, strips of {length} x {width} nm.
#   contact, device_contact, heights, spectrum, pair_model_error_dry, model_error_of_devices ->
#     results/devices/ground/{case}_{length}x{width}.nc
define("ground")

# Effect of attraction across gaps on device {device}.
#   contact, device_contact, tip_contact, model_error_of_devices -> results/devices/left_out_gaps/{device}.nc
define("left_out_gaps")

# Simulated limits of {case}.
#   cracks, tip_contact, pair_model_error_dry, model_error_of_devices, safe_lengths, contact ->
#     results/devices/safe_lengths/{case}.nc
define("safe_lengths")

# Simulated limits of {case} for many touchdowns.
#   cracks, tip_contact, model_error_of_devices -> results/devices/touchdowns/{case}.nc
define("touchdowns")

# Simulated limits of {case} at its voltage.
#   cracks, tip_contact, model_error_of_devices, contact -> results/devices/at_voltage/{case}.nc
define("at_voltage")

# Pull-off force of stopper {device}.
#   device_contact, model_error_of_devices, model_error_of_probes -> results/devices/stoppers/{device}.nc
define("stoppers")

# Pull-off force of the dimples of {case}.
#   device_contact, model_error_of_devices -> results/devices/dimples/{case}.nc
define("dimples")

# Pull-off force of tilted stopper {device}.
#   device_contact, model_error_of_devices, tilted_contact -> results/devices/tilted/{device}.nc
define("tilted_stoppers")

# Pull-off force of stopper {device} at its voltage.
#   device_contact, model_error_of_devices -> results/devices/at_voltage/{device}.nc
define("stoppers_at_voltage")

# Fast separation of stopper {device}.
#   device_contact, model_error_of_devices, model_error_of_probes -> results/devices/separation/{device}.nc
define("separation")

# Fast separation of {case}, strips of {length} x {width} nm.
#   contact, device_contact, model_error_of_devices -> results/devices/fast_strips/{case}_{length}x{width}.nc
define("fast_strips")

# Fast separation of tips of {case}, {length} x {width} nm.
#   tip_contact, model_error_of_devices -> results/devices/fast_tips/{case}_{length}x{width}.nc
define("fast_tips")

# Life of device {device}.
#   safe_lengths, fast_strips, fast_tips, touchdowns, at_voltage, stoppers_at_voltage, dimples, stoppers,
#     separation, tilted_stoppers -> results/devices/life/{device}.nc
define("life")

# Test beams of device {device}.
#   budget, tip_budget, test_beam_budget, test_beam_tip_budget, safe_lengths, contact, tip_contact,
#     model_error_of_devices -> results/devices/test_beams/{device}.nc
define("test_beams")

# Device {device} at the inputs that its test beams suggest.
#   test_beams, budget, test_beam_budget, contact, device_contact, model_error_of_devices, heights, spectrum
#     -> results/devices/test_beams/rerun/{device}.nc
define("test_beams_rerun")

# Answer about device {device}.
#   budget, tip_budget, life, fast_strips, fast_tips, test_beams, safe_lengths, chart, at_voltage,
#     stoppers_at_voltage, touchdowns, separation, stoppers, tilted_stoppers ->
#     results/devices/answer/{device}.nc
define("answer")

# Estimate at once of {device} beside its run.
#   safe_lengths -> results/devices/estimate/{device}.nc
define("device_estimate")

# Estimate at once of {device} beside its run.
#   stoppers -> results/devices/estimate_of_force/{device}.nc
define("stopper_estimate")
