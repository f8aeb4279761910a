"""Random rough surfaces (Sec. II): density of the heights, spectrum, simulation, summits and identification."""
