"""Life of a device beside its adhesion: causes of contact, drying, and ways to free it again."""
