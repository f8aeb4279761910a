"""Formulas of the paper's additional studies: sensitivity, validity, convergence (App. A–C)."""
