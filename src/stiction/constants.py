"""Physical constants in SI units, each with unit and source. None is a tuning parameter."""

#: Molar gas constant [J mol⁻¹ K⁻¹], exact; SI of 2019.
GAS_CONSTANT = 8.31446261815324

#: Molar volume of liquid water, 300 K [m³ mol⁻¹]; paper, below Eq. (8).
WATER_MOLAR_VOLUME = 1.8e-5
#: Liquid-vapour surface energy γ_LG of water, 300 K [N m⁻¹]; paper, below Eq. (8).
WATER_SURFACE_ENERGY = 0.072
#: Diameter of a water molecule [m]; distance of neighbours in liquid water, X-ray diffraction (Narten and Levy, 1971).
WATER_MOLECULE = 2.8e-10

#: Hamaker constants of polysilicon through a medium [J]; paper, below Eq. (10).
HAMAKER_CONSTANT = {"water": 9.75e-20, "dry": 18.65e-20}
#: Distance at which the potential between two molecules is zero, r₀ [m]; paper, below Eq. (10).
MOLECULAR_DISTANCE = 2.09e-10

#: Hardness σ_H of (poly)silicon [Pa]; paper, App. A.
HARDNESS = 12.8e9

#: Density of (poly)silicon [kg m⁻³]; crystal at 300 K, CRC Handbook of Chemistry and Physics.
DENSITY = 2330.0
#: Surface energies of liquids in which beams are released, against their vapour [N m⁻¹]. Water as above, isopropanol at
#: 293 K (Vázquez, Alvarez and Navaza, J. Chem. Eng. Data 40, 611, 1995).
LIQUIDS = {"water": WATER_SURFACE_ENERGY, "isopropanol": 0.0217}
#: Permittivity of vacuum ε₀ [F m⁻¹]; CODATA 2018.
VACUUM_PERMITTIVITY = 8.8541878128e-12
#: Standard acceleration of free fall g [m s⁻²], exact.
FREE_FALL = 9.80665
