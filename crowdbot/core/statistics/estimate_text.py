"""An estimate as text, the same on every page: report, leaderboard and Markdown.

`element.js` of the report has the same rule for numbers that only a browser works out; both round
halves away from zero, as ``Number.prototype.toFixed`` does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from decimal import ROUND_HALF_UP, Context, Decimal

from crowdbot.core.statistics.estimate import Estimate

NOTHING = "–"
_MINUS = "−"
_MOST, _LARGE = 6, 1e6
_EXACT = Context(prec=800)  # a double has at most 767 digits


def estimate_text(found: Estimate, minus: str = _MINUS) -> tuple[str, str]:
    """The value, and its interval in brackets; "–" and nothing where there is none."""
    if found.value is None:
        return NOTHING, ""
    width = 0.0 if found.low is None or found.high is None else found.high - found.low
    decimals = _decimals(abs(found.value), width if math.isfinite(width) else 0.0)
    value = number_text(found.value, decimals, minus)
    if found.low is None or found.high is None or not math.isfinite(width):
        return value, ""
    low, high = (number_text(x, decimals, minus) for x in (found.low, found.high))
    return value, f"[{low}, {high}]"


def joined_text(found: Estimate) -> str:
    """Both in one line."""
    return " ".join(filter(None, estimate_text(found)))


def range_text(ends: tuple[float | None, float | None]) -> str:
    """Between which bounds something lies; "?" where there is none."""
    known = [x for x in ends if x is not None]
    decimals = decimals_for(known)
    low, high = ("?" if x is None else number_text(x, decimals) for x in ends)
    return f"in [{low}, {high}]"


def decimals_for(numbers: Iterable[float]) -> int:
    """Decimals that show three digits of the largest number, and two of what they differ by."""
    known = [float(x) for x in numbers if math.isfinite(x)]
    return _decimals(max([0.0, *map(abs, known)]), max(known) - min(known) if known else 0.0)


def _decimals(size: float, spread: float) -> int:
    """Three digits of a size, and two of a spread that is more than rounding."""
    seen = _places(spread, 2) if spread > 1e-6 * size else 0
    return min(9, max(0, _places(max(size, spread), 3), seen))


def number_text(number: float, decimals: int, minus: str = _MINUS) -> str:
    """With so many decimals; very large and very small ones as a power of ten."""
    if not math.isfinite(number):
        return NOTHING
    if number == 0 and decimals > _MOST:
        return "0"
    text = format(_rounded(number, -decimals), "f")
    is_zero = float(text) == 0
    if number != 0 and (is_zero or abs(number) >= _LARGE or decimals > _MOST):
        text = _power(number)
    elif is_zero:
        text = text.replace("-", "")
    return text.replace("-", minus)


def _power(number: float) -> str:
    """Two decimals and the power of ten."""
    exponent = Decimal(number).adjusted()
    exponent = _rounded(number, exponent - 2).adjusted()  # 9.999 is 1.00e+1
    mantissa = _rounded(number, exponent - 2).scaleb(-exponent, _EXACT)
    return f"{mantissa:.2f}e{exponent:+d}"


def _rounded(number: float, last: int) -> Decimal:
    """To a multiple of ten to this power, halves away from zero."""
    return Decimal(number).quantize(Decimal(1).scaleb(last), ROUND_HALF_UP, _EXACT)


def _places(size: float, shown: int) -> int:
    """Decimals that show so many digits of a size."""
    return shown - 1 - Decimal(repr(float(size))).adjusted() if 0 < size < math.inf else 0
