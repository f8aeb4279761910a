"""Changes of single keys of a configuration or of the settings of a job."""

from collections.abc import Mapping
from typing import Any


def merged(base: Any, overlay: Any) -> Any:
    """Mapping ``base`` changed key by key, as Snakemake does; lists and numbers are replaced as a whole."""
    if not (isinstance(base, Mapping) and isinstance(overlay, Mapping)):
        return overlay
    return {**base, **{key: merged(base.get(key), value) for key, value in overlay.items()}}
