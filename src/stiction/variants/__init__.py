"""Variants: the result under one changed model choice each, where the paper leaves the choice open."""
