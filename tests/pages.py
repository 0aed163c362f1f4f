"""A page as a reader's program takes it: what it would load, its tables, its text."""

from html.parser import HTMLParser

LOADING = {"src", "href", "srcset", "data", "poster", "action", "background"}


class Page(HTMLParser):
    """Parsed page; scripts and styles are no text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.captions: list[str] = []
        self.order: list[str] = []
        self.words: list[str] = []
        self._within = ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self._within = tag
        found = dict(attrs)
        self.loaded += [value for name, value in found.items() if name in LOADING and value]
        self.order.append(found.get("class") or found.get("id") or tag)

    def handle_endtag(self, tag):
        self._within = ""

    def handle_data(self, data):
        if self._within in ("script", "style"):
            return
        self.words += data.split()
        if self._within == "h3":
            self.captions.append(data)

    @property
    def text(self) -> str:
        """What is read, its white space made even."""
        return " ".join(self.words)
