"""Mechanisms in notebooks."""
import html
import os

from ._arguments import PathLike


class View:
    """A mechanism: `page`, HTML in which it moves, that needs nothing else; `picture`, SVG of how it begins. A notebook
    shows the page, and the picture where it shows no HTML."""

    def __init__(self, page: str, picture: str) -> None:
        self.page, self.picture = page, picture

    def save(self, path: PathLike) -> None:
        """Writes the page, or the picture where the name ends in .svg."""
        name = os.fspath(path)
        with open(name, "w", encoding="utf-8") as file:
            file.write(self.picture if name.endswith(".svg") else self.page)

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.page)}" title="the mechanism, moving" width="100%" height="700" '
            'style="border: 0"></iframe>'
        )

    def _repr_svg_(self) -> str:
        return self.picture

    def __repr__(self) -> str:
        return "<twinmap.View: save(path) writes it>"
