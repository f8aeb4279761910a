"""Running the workflow: fingerprints of the code, provenance, logs, locks and compilation."""
