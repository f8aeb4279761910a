"""Logger plugin of Snakemake, ``snakemake --logger stiction``: one line of progress in place of the whole log."""

from logging import LogRecord

from snakemake_interface_logger_plugins.base import LogHandlerBase

from stiction.command.follow import RUN

__all__ = ["LogHandler"]


class LogHandler(LogHandlerBase):
    """Passes everything that Snakemake reports to the run that this process follows."""

    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = False

    @property
    def writes_to_stream(self) -> bool:
        """Whether Snakemake leaves the terminal to this plugin."""
        return RUN.quiet

    def emit(self, record: LogRecord) -> None:
        """Follow one report."""
        RUN.hear(record)
