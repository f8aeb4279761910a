"""Formulas of what the paper shows beside its main result: sensitivity, validity, convergence (App. A–C)."""
