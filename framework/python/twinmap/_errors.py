"""What is wrong with an input, as exceptions."""
from typing import Optional


class ExperimentError(ValueError):
    """An experiment, or another input, that cannot be used.

    The message names file:line:column, key path, the value found and the rule that it breaks; so do the attributes, as
    far as they are known: `file`, `line`, `column` (from 1), `key` ("system.springs[0].stiffness"), `value`, `rule`.
    Overrides stand in the file "command line".
    """

    def __init__(
        self,
        message: str,
        file: Optional[str] = None,
        line: Optional[int] = None,
        column: Optional[int] = None,
        key: Optional[str] = None,
        value: Optional[str] = None,
        rule: Optional[str] = None,
    ) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column
        self.key = key
        self.value = value
        self.rule = message if rule is None else rule


class MeasurementError(ExperimentError):
    """A measurement that cannot be used; the message names the file, line or time, column, value and rule."""
