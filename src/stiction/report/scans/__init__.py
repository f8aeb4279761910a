"""Tables and figures of surfaces described by scans."""
