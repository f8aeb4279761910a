"""Learning of the estimate: surfaces and contacts that it learns from, fit, intervals, and errors on other surfaces."""
