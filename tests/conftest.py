"""Settings of all tests."""

from hypothesis import settings

# No deadline, because machines are shared and timings vary; the same examples in every run.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")
