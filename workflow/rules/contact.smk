"""Contact beside the chain: patches and tips of devices, changed inputs, variants, full elastic contact.

A comment says what each rule does, whose results it reads -> which files it writes.

Written by docs/rules.py from the declarations of the stages: change these, then run make numbers.
"""

# Readings of an asperity, pair {pair}.
#   heights, spectrum -> results/studies/asperities/{pair}.nc
define("readings")

# Contact of pair {pair}, {length} x {width} nm.
#   heights, spectrum -> results/devices/contact/{pair}_{length}x{width}.nc
define("device_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams.
#   heights, spectrum -> results/devices/contact/tips/{pair}_{length}x{width}.nc
define("tip_contact")

# Contact of pair {pair}, {length} x {width} nm, of tilted stoppers.
#   heights, spectrum -> results/devices/contact/tilted/{pair}_{length}x{width}.nc
define("tilted_contact")

# Contact of pair {pair} with less and more {quantity} of {surface}.
#   heights, spectrum, estimate -> results/studies/slopes/contact/{pair}_{surface}_{quantity}_{each}.nc
define("slope_contact")

# Contact of pair {pair}, {length} x {width} nm, with less and more {quantity} of {surface}.
#   heights, spectrum -> results/devices/contact/slopes/{pair}_{length}x{width}_{surface}_{quantity}_{each}.nc
define("device_slope_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams, with less and more {quantity} of {surface}.
#   heights, spectrum ->
#     results/devices/contact/tips/slopes/{pair}_{length}x{width}_{surface}_{quantity}_{each}.nc
define("tip_slope_contact")

# Contact of pair {pair}, {length} x {width} nm, with {member} in place of the partly assumed {surface}.
#   no results -> results/devices/contact/members/{pair}_{length}x{width}_{surface}_like_{member}.nc
define("device_member_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams, with {member} in place of the partly assumed {surface}.
#   no results -> results/devices/contact/tips/members/{pair}_{length}x{width}_{surface}_like_{member}.nc
define("tip_member_contact")

# Contact of pair {pair} with less and more of each moment (Fig. 13).
#   heights, spectrum -> results/studies/sensitivity/contact/{pair}_{each}.nc
define("sensitivity_contact")

# Contact of pair {pair} with the other value of {choice}.
#   heights, spectrum, estimate -> results/studies/choices/{pair}_{choice}.nc
define("choice_contact")

# Contact of pair {pair}, {length} x {width} nm, with {side} {solid_property}.
#   heights, spectrum -> results/devices/contact/{solid_property}/{pair}_{length}x{width}_{side}.nc
define("solid_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams, with {side} {solid_property}.
#   heights, spectrum -> results/devices/contact/tips/{solid_property}/{pair}_{length}x{width}_{side}.nc
define("tip_solid_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams, with {side} round edges.
#   heights, spectrum -> results/devices/contact/tips/edge/{pair}_{length}x{width}_{side}.nc
define("tip_edge_contact")

# Contact of pair {pair}, {length} x {width} nm, at the tips of beams, under variant {variant}.
#   heights, spectrum -> results/devices/contact/tips/choices/{pair}_{length}x{width}_{variant}.nc
define("tip_choice_contact")

# Summits of pair {pair} under variant {variant}.
#   identification, heights, spectrum -> results/studies/variants/summits/{pair}_{variant}.nc
define("variant_summits")

# Summits of pair {pair}, {length} x {width} nm, under variant {variant}.
#   identification -> results/devices/contact/summits/{pair}_{length}x{width}_{variant}.nc
define("device_choice_summits")

# Contact of pair {pair} under variant {variant}.
#   variant_summits -> results/studies/variants/contact/{pair}_{variant}.nc
define("variant_contact")

# Contact of pair {pair}, {length} x {width} nm, under variant {variant}.
#   device_choice_summits -> results/devices/contact/choices/{pair}_{length}x{width}_{variant}.nc
define("device_choice_contact")

# Contact of islands of pair {pair} under variant {variant}.
#   no results -> results/studies/variants/islands/{pair}_{variant}.nc
define("variant_islands")

# Full elastic contact of pair {pair}, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/{pair}.nc
define("full_contact")

# Full elastic contact of pair {pair} with attraction across gaps, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/across/{pair}.nc
define("full_contact_across")

# Full elastic contact of pair {pair} in dry air, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/dry/{pair}.nc
define("full_contact_dry")

# Energies of {case} in full elastic contact.
#   heights, spectrum -> results/studies/full_contact/energy/{case}.nc
define("full_energy")

# Error of the model of the contact of pair {pair}.
#   full_contact, tips_in_full_contact -> results/studies/model_error/{pair}.nc
define("pair_model_error")

# Error of the model of the contact of pair {pair} with attraction across gaps.
#   full_contact_across, tips_in_full_contact_across -> results/studies/model_error/across/{pair}.nc
define("pair_model_error_across")

# Error of the model of the contact of pair {pair} in dry air.
#   full_contact_dry, tips_in_full_contact_dry -> results/studies/model_error/dry/{pair}.nc
define("pair_model_error_dry")

# Full elastic contact of pair {pair} under devices, over the sum over summits.
#   full_energy, tips_of_devices, full_contact_dry, tips_in_full_contact_dry ->
#     results/studies/model_error/devices/{pair}.nc
define("model_error_of_devices")

# Stress of the touching summits of pair {pair} (App. A).
#   heights, spectrum -> results/studies/plasticity/{pair}.nc
define("plasticity")

# Pair {pair} after its surfaces were pressed together.
#   heights, spectrum -> results/studies/pressing/{pair}.nc
define("pressed")

# Full elastic contact of probe {device}, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/probes/{device}.nc
define("probe_in_full_contact")

# Full elastic contact of probe {device}, over the sum over summits.
#   probe_in_full_contact -> results/studies/model_error/probes/{device}.nc
define("model_error_of_probes")

# Full elastic contact of the tips of beams of pair {pair}, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/tips/{pair}.nc
define("tips_in_full_contact")

# Full elastic contact of the tips of beams of pair {pair} with attraction across gaps, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/tips/across/{pair}.nc
define("tips_in_full_contact_across")

# Full elastic contact of the tips of beams of pair {pair} in dry air, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/tips/dry/{pair}.nc
define("tips_in_full_contact_dry")

# Full elastic contact of the tips of devices of {case}, beside the sum over summits.
#   heights, spectrum -> results/studies/full_contact/tips/devices/{case}.nc
define("tips_of_devices")
