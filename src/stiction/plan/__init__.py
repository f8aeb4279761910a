"""What is computed for a configuration: the declarations of all stages, and the jobs that follow from them."""
