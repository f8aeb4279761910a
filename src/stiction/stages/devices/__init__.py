"""Stages of devices: cracks of long beams, safe lengths, charts, stoppers, budgets, warnings."""
