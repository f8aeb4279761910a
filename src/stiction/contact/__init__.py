"""Adhesive contact of two rough surfaces and its force laws (Secs. III-A and III-B1)."""
