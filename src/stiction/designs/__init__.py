"""Stages of devices: cracks of long beams, safe lengths, charts, stoppers and budgets; tables, figures and pages."""
