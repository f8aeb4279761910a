"""Logger plugin of Snakemake, ``snakemake --logger stiction``: one line of progress in place of the whole log."""

from logging import LogRecord

from snakemake_interface_logger_plugins.base import LogHandlerBase

__all__ = ["LogHandler"]


class LogHandler(LogHandlerBase):
    """Passes everything that Snakemake reports to the run that this process follows."""

    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = False

    def __post_init__(self) -> None:
        # Not at the top: Snakemake imports all plugins before a Snakefile says which code is its own.
        from stiction.command.run_state import RUN

        self._run = RUN

    @property
    def writes_to_stream(self) -> bool:
        """Whether Snakemake leaves the terminal to this plugin."""
        return self._run.quiet

    def emit(self, record: LogRecord) -> None:
        """Follow one report."""
        self._run.hear(record)
