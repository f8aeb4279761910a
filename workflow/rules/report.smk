"""Tables, figures and pages, and the checks of a run.

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Risk: P(stuck) of devices against their size, and what to build.
#   answer, device_warnings -> results/figures/risk.{pdf,png,txt}
define("figure_risk")

# Devices: verdicts on all devices.
#   answer, device_warnings -> results/tables/devices.{csv,md,html}
define("table_devices")

# Estimate: estimates at once beside the run.
#   device_estimate -> results/tables/estimate.{csv,md,html}
define("table_estimate")

# Estimate of force: forces at once beside the run.
#   stopper_estimate -> results/tables/estimate_of_force.{csv,md,html}
define("table_estimate_of_force")

# Roughness {device}: how rough the surfaces of {device} must be.
#   roughness -> results/figures/roughness_{device}.{pdf,png,txt}
define("figure_roughness")

# Roughness map {device}: how rough the surfaces of {device} must be, over two quantities.
#   roughness -> results/figures/roughness_map_{device}.{pdf,png,txt}
define("figure_roughness_map")

# Process {device}: which settings of its process leave {device} free.
#   process_curve, process_settings -> results/figures/process_{device}.{pdf,png,txt}
define("figure_process")

# Process law {process}: surface over the variable of process {process}.
#   process_law -> results/figures/process_law_{process}.{pdf,png,txt}
define("figure_process_law")

# Process map {device}: which pairs of settings of two processes leave {device} free.
#   process_map, process_pairs -> results/figures/process_map_{device}.{pdf,png,txt}
define("figure_process_map")

# Roughness: how rough a surface must be.
#   roughness -> results/tables/roughness.{csv,md,html}
define("table_roughness")

# Process: which settings of a process suffice.
#   process_curve, process_settings, process_law -> results/tables/process.{csv,md,html}
define("table_process")

# Process map: which pairs of settings of two processes suffice.
#   process_map, process_pairs, process_law -> results/tables/process_map.{csv,md,html}
define("table_process_map")

# Figure 14: shapes and crack lengths of beams.
#   beams -> results/figures/figure_14.{pdf,png,txt}
define("figure_14")

# Figure 15: adhesion energy against relative humidity.
#   beams, humidity -> results/figures/figure_15.{pdf,png,txt}
define("figure_15")

# Overview: from surfaces to crack lengths.
#   character, forces, beams -> results/figures/overview.{pdf,png,txt}
define("figure_overview")

# Intervals: crack lengths with prediction intervals.
#   table_3 -> results/figures/intervals.{pdf,png,txt}
define("figure_intervals")

# Table 3: crack lengths and adhesion energies.
#   beams, forces, scan_uncertainty, estimate, spectrum, pair_model_error, pair_model_error_across ->
#     results/tables/table_3.{csv,md,html}
define("table_3")

# Fit quality: fit of the force curves by Eq. (12).
#   fit -> results/tables/fit_quality.{csv,md,html}
define("fit_quality")

# Resampling: effect of the chaos model on the crack length.
#   beams, resampling -> results/tables/resampling.{csv,md,html}
define("table_resampling")

# Stoppers: pull-off force of stoppers.
#   stoppers, answer, device_warnings -> results/figures/stoppers.{pdf,png,txt}
define("figure_stoppers")

# Budget {device}: uncertainty of {device}.
#   budget, tip_budget -> results/figures/budget_{device}.{pdf,png,txt}
define("figure_budget")

# Stoppers: P(stuck) of stoppers.
#   stoppers, device_warnings, device_model_error -> results/tables/stoppers.{csv,md,html}
define("table_stoppers")

# Budget: uncertainty of devices, and what to measure better.
#   budget, tip_budget, device_model_error -> results/tables/budget.{csv,md,html}
define("table_budget")

# Check the results.
#   heights, spectrum, identification, character, forces, chaos, beams, resampling -> results/checks.{csv,md}
define("checks")

# Fail if a check has failed.
#   checks -> results/verdict.txt
define("verdict")

# Compared table 3: mean crack length for values of one key.
#   table_3 -> results/tables/compared_table_3.{csv,md,html}
define("table_compared_table_3")

# Compared table 3: mean crack length for values of one key.
#   table_3 -> results/figures/compared_table_3.{pdf,png,txt}
define("figure_compared_table_3")

# Compared safe lengths: length that a share p holds for values of one key.
#   table_safe_lengths -> results/tables/compared_safe_lengths.{csv,md,html}
define("table_compared_safe_lengths")

# Compared safe lengths: length that a share p holds for values of one key.
#   table_safe_lengths -> results/figures/compared_safe_lengths.{pdf,png,txt}
define("figure_compared_safe_lengths")

# Compared stoppers: pull-off force for values of one key.
#   table_stoppers -> results/tables/compared_stoppers.{csv,md,html}
define("table_compared_stoppers")

# Compared stoppers: pull-off force for values of one key.
#   table_stoppers -> results/figures/compared_stoppers.{pdf,png,txt}
define("figure_compared_stoppers")

# Asperities: Table III under several readings of an asperity.
#   readings, full_contact, beams -> results/tables/asperities.{csv,md,html}
define("table_asperities")

# Model error parts: parts of the error of the model.
#   readings, full_contact -> results/tables/model_error_parts.{csv,md,html}
define("table_model_error_parts")

# Asperities: crack lengths under several readings of an asperity.
#   readings, full_contact, beams -> results/figures/asperities.{pdf,png,txt}
define("figure_asperities")

# Pressing: adhesion after surfaces were pressed together.
#   pressed -> results/tables/pressing.{csv,md,html}
define("table_pressing")

# Pressing: adhesion after surfaces were pressed together.
#   pressed -> results/figures/pressing.{pdf,png,txt}
define("figure_pressing")

# Chart: simulated limit against relative humidity.
#   chart, device_warnings -> results/figures/chart.{pdf,png,txt}
define("figure_chart")

# Life: what brings devices into contact, holds and frees them.
#   life -> results/tables/life.{csv,md,html}
define("table_life")

# Life: what limits the life of devices, on one axis.
#   life, answer, device_warnings -> results/figures/life.{pdf,png,txt}
define("figure_life")

# Page of device {device}.
#   answer, life, budget, tip_budget, device_warnings, device_model_error, test_beams_rerun, device_estimate,
#     stopper_estimate, safe_lengths, roughness, stoppers, stoppers_at_voltage, tilted_stoppers,
#     process_curve, process_settings, process_law, chart, process_map, process_pairs ->
#     results/devices/{device}.{html,txt}
define("device_page")

# Simulated limits of beams.
#   safe_lengths, device_warnings, device_model_error -> results/tables/safe_lengths.{csv,md,html}
define("table_safe_lengths")

# Chart: simulated limit against relative humidity.
#   chart, device_warnings -> results/tables/chart.{csv,md,html}
define("table_chart")

# Limits of the model that devices exceed.
#   device_warnings, test_beams_rerun, answer -> results/devices/warnings.{md,json}
define("device_limits")

# Figure 5: a force curve, its force law and its parameters.
#   forces, fit -> results/figures/figure_05.{pdf,png,txt}
define("figure_05")

# Figure 12: computed and generated force curves.
#   forces, chaos -> results/figures/figure_12.{pdf,png,txt}
define("figure_12")

# Limits of the model that pairs exceed.
#   beams, plasticity, estimate, spectrum -> results/warnings.{md,json}
define("model_limits")

# Model error: Table III under full elastic contact.
#   pair_model_error, pair_model_error_across, beams, variant -> results/tables/model_error.{csv,md,html}
define("table_model_error")

# Model error: crack lengths under full elastic contact.
#   pair_model_error, pair_model_error_across, beams, variant -> results/figures/model_error.{pdf,png,txt}
define("figure_model_error")

# Surface sheet {surface}: scans of {surface}.
#   estimate, spectrum -> results/figures/surface_sheet_{surface}.{pdf,png,txt}
define("surface_sheet")

# Scans: scans of the measured surfaces.
#   estimate, spectrum, scan -> results/tables/scans.{csv,md,html}
define("table_scans")

# Scan uncertainty: uncertainty due to finite scans.
#   scan_uncertainty -> results/tables/scan_uncertainty.{csv,md,html}
define("table_scan_uncertainty")

# Figure 13: sensitivity to the moments of a surface.
#   sensitivity -> results/figures/figure_13.{pdf,png,txt}
define("figure_13")

# Figure 16: stress of the touching summits.
#   plasticity -> results/figures/figure_16.{pdf,png,txt}
define("figure_16")

# Figure 17: convergence in samples and coordinates.
#   sample_sizes, chaos -> results/figures/figure_17.{pdf,png,txt}
define("figure_17")

# Figure 18: convergence in the order of the polynomials.
#   orders -> results/figures/figure_18.{pdf,png,txt}
define("figure_18")

# Figure 19: convergence of the mesh, autocorrelation.
#   mesh, correlation -> results/figures/figure_19.{pdf,png,txt}
define("figure_19")

# Variants: Table III under other model choices.
#   variant -> results/figures/variants.{pdf,png,txt}
define("figure_variants")

# Sensitivity: sensitivity to the moments of a surface.
#   sensitivity -> results/tables/sensitivity.{csv,md,html}
define("table_sensitivity")

# Variants: Table III under other model choices.
#   variant -> results/tables/variants.{csv,md,html}
define("table_variants")

# Figure 7: densities of the heights.
#   heights -> results/figures/figure_07.{pdf,png,txt}
define("figure_07")

# Figure 8: simulated surfaces.
#   character -> results/figures/figure_08.{pdf,png,txt}
define("figure_08")

# Figure 9: Gaussian and non-Gaussian profile.
#   character -> results/figures/figure_09.{pdf,png,txt}
define("figure_09")

# Figure 10: spectra of simulated surfaces.
#   heights, spectrum, character, iteration -> results/figures/figure_10.{pdf,png,txt}
define("figure_10")

# Figure 11: heights and radii of summits.
#   character -> results/figures/figure_11.{pdf,png,txt}
define("figure_11")

# Figure 11 supplement: heights and radii of summits, other surfaces.
#   character -> results/figures/figure_11_supplement.{pdf,png,txt}
define("figure_11_supplement")

# Table 1: statistics of the surfaces.
#   heights, character, estimate -> results/tables/table_1.{csv,md,html}
define("table_1")

# Table 2: spectra and their identification.
#   identification, spectrum -> results/tables/table_2.{csv,md,html}
define("table_2")

# Test beams {device}: what test beams say about {device}.
#   test_beams -> results/figures/test_beams_{device}.{pdf,png,txt}
define("figure_test_beams")

# Test beams: what test beams say about devices.
#   test_beams_rerun -> results/tables/test_beams.{csv,md,html}
define("table_test_beams")
