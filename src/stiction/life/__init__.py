"""Life of a device beside its adhesion: what brings it into contact, what drying does, what frees it again."""
