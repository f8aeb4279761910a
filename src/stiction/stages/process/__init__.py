"""Stages of processes: laws of surfaces, devices over a process variable, and recommended settings."""
