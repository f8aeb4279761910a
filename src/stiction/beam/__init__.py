"""Cantilever beams on a rough substrate: equilibrium, release and Monte Carlo (Secs. III-C and IV)."""
