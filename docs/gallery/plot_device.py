"""
How long may a cantilever be?
=============================

A beam that touches its substrate comes free if it is shorter than its crack. Cracks scatter, so that the answer is a
length at which at most a given share of the beams sticks.
"""

import matplotlib.pyplot as plt

import stiction

# %%
# The device
# ----------
# Keys carry their units; sizes below are smaller than those of the workflow, so that this takes seconds.

config = stiction.load(
    {
        "run": {"pairs": []},
        "contact": {"samples": 300},
        "chaos": {"order": 4},
        "design": {"beams": 300, "shares": [0.01]},
        "devices": {
            "C1": {
                "kind": "cantilever",
                "pair": "b",
                "thickness_um": 2.6,
                "gap_um": 20,
                "width_um": 30,
                "humidities": [0.44, 0.67],
            }
        },
    }
)
device = stiction.Device.of(config, "C1")

# %%
# P(stuck) over the length
# ------------------------
# The beam may be held by its whole width, or by its tip alone.

plt.rc("font", size=15)
figure = plt.figure(figsize=(6.4, 5.6), layout="constrained")
for humidity in (0.44, 0.67):
    lengths = device.safe_lengths(humidity)
    for shape, line in zip(lengths["shape"].values, ("-", "--"), strict=False):
        curve = lengths.sel(shape=shape)
        plt.semilogy(1e6 * curve.length, curve.stuck, line, label=f"RH {humidity}, {shape}")
        limit = 1e6 * float(curve.safe_length.sel(share=0.01))
        print(f"RH {humidity}, {shape}: simulated limit {limit:.0f} µm, at which at most 1 % stick")
plt.xlabel("length of the beam [µm]")
plt.ylabel("P(stuck) [–]")
figure.legend(loc="outside lower center")
plt.show()

# %%
# Where the answer is beyond what the model covers, sentences say so.

print("\n".join(device.warnings(device.safe_lengths(0.44))))
