"""Where results are beyond the model, as data, and the rules that find it."""
