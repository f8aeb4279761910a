"""Stages of devices: cracks of long beams, safe lengths and charts; they follow the stages of the main line."""
