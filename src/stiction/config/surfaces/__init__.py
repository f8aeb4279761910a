"""How surfaces are described in a configuration."""
