"""Measurements on devices that bear on their inputs."""
