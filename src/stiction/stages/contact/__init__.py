"""Stages of contact: solid pressure and bearing area of pairs, also with one thing changed (Sec. III-A)."""
