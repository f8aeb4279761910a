"""Text that does something wherever it is more than text, and what a browser makes of a page."""

from html.parser import HTMLParser

#: Signs of Jinja, HTML, Matplotlib and Markdown. The template calls a function, which makes a folder with its own name.
TEMPLATE = "{{ lipsum.__globals__.os.mkdir(lipsum.__name__) }}"
MADE = "generate_lorem_ipsum"
HOSTILE = f"{{% endraw %}}{TEMPLATE}{{{{7*7}}}}{{% raw %}}</p></script><script>alert(1)</script>$x$|&lt;[a](b)'\"\\"
#: The same in the name of a file, of which Snakemake reads no braces and no slash can be a part.
HOSTILE_FILE = "a|b<I onload=alert(1)>$x$&lt;[a](b)'.gwy"
#: Elements and attributes of HTML that run code.
_SCRIPTS = {"script", "iframe", "object", "embed", "base", "meta"}


def places(node, path=()):
    """Paths to all nodes of a tree of dicts and lists."""
    yield path
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield from places(value, (*path, key))


class Reading(HTMLParser):
    """Text of a page, by element, of its pictures, and everything on it that runs code."""

    def __init__(self, page: str):
        super().__init__()
        self.text, self.alt, self.code, self._open = {}, [], [], []
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.text.setdefault(tag, []).append("")
        self._open.append(tag)
        self.code += [tag] * (tag in _SCRIPTS)
        self.alt += [value for name, value in attributes if name == "alt"]
        self.code += [value for name, value in attributes if name.startswith("on") or "script:" in (value or "")]

    def handle_endtag(self, tag):
        if tag in self._open:
            del self._open[len(self._open) - 1 - self._open[::-1].index(tag) :]

    def handle_data(self, data):
        for tag in set(self._open):
            self.text[tag][-1] += data
