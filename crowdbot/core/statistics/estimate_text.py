"""An estimate as text, the same in report, leaderboard and Markdown.

`element.js` of the report follows the same rule for numbers computed in the browser; both round
halves away from zero, as ``Number.prototype.toFixed`` does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from decimal import ROUND_HALF_UP, Context, Decimal

from crowdbot.core.statistics.estimate import Estimate

NOTHING = "–"
_MINUS = "−"
#: Numbers beyond these, or that need more decimals, are powers of ten.
_MOST, _LARGE, _SMALL = 6, 1e6, 1e-4
_EXACT = Context(prec=800)  # a double has at most 767 digits


def estimate_text(estimate: Estimate, minus: str = _MINUS) -> tuple[str, str]:
    """Return the value, and its interval in brackets; "–" and nothing if there is none."""
    if estimate.value is None:
        return NOTHING, ""
    width = 0.0 if estimate.low is None or estimate.high is None else estimate.high - estimate.low
    decimals = _decimals(abs(estimate.value), width if math.isfinite(width) else 0.0)
    value = number_text(estimate.value, decimals, minus)
    if estimate.low is None or estimate.high is None or not math.isfinite(width):
        return value, ""
    low, high = (number_text(x, decimals, minus) for x in (estimate.low, estimate.high))
    return value, f"[{low}, {high}]"


def joined_text(estimate: Estimate) -> str:
    """Return value and interval in one line."""
    return " ".join(filter(None, estimate_text(estimate)))


def range_text(ends: tuple[float | None, float | None]) -> str:
    """Return the bounds as text; "?" if there are none."""
    known = [x for x in ends if x is not None]
    decimals = decimals_for(known)
    low, high = ("?" if x is None else number_text(x, decimals) for x in ends)
    return f"in [{low}, {high}]"


def decimals_for(numbers: Iterable[float]) -> int:
    """Return decimals for three digits of the largest number, and two of the differences."""
    known = [float(x) for x in numbers if math.isfinite(x)]
    return _decimals(max([0.0, *map(abs, known)]), max(known) - min(known) if known else 0.0)


def _decimals(size: float, spread: float) -> int:
    """Return decimals for three digits of a size, and two of a spread larger than rounding."""
    seen = _places(spread, 2) if spread > 1e-6 * size else 0
    return min(9, max(0, _places(max(size, spread), 3), seen))


def number_text(number: float, decimals: int, minus: str = _MINUS) -> str:
    """Format a number with this many decimals, or with two digits if it would show as zero.

    Very large or small ones are written as a power of ten.
    """
    if not math.isfinite(number):
        return NOTHING
    if number == 0 and decimals > _MOST:
        return "0"
    text = format(_rounded(number, -decimals), "f")
    is_zero = float(text) == 0
    if number != 0 and is_zero and abs(number) >= _SMALL and decimals <= _MOST:
        text = _two_digits(number)
    elif number != 0 and (is_zero or abs(number) >= _LARGE or decimals > _MOST):
        text = _power(number)
    elif is_zero:
        text = text.replace("-", "")
    return text.replace("-", minus)


def _two_digits(number: float) -> str:
    last = Decimal(number).adjusted() - 1
    last = _rounded(number, last).adjusted() - 1  # 0.0996 is 0.10
    return format(_rounded(number, last), "f")


def _power(number: float) -> str:
    """Format a number with two decimals and its power of ten."""
    exponent = Decimal(number).adjusted()
    exponent = _rounded(number, exponent - 2).adjusted()  # 9.999 is 1.00e+1
    mantissa = _rounded(number, exponent - 2).scaleb(-exponent, _EXACT)
    return f"{mantissa:.2f}e{exponent:+d}"


def _rounded(number: float, last: int) -> Decimal:
    """Round to a multiple of this power of ten, halves away from zero."""
    return Decimal(number).quantize(Decimal(1).scaleb(last), ROUND_HALF_UP, _EXACT)


def _places(size: float, shown: int) -> int:
    """Return the decimals that show this many digits of a size."""
    return shown - 1 - Decimal(repr(float(size))).adjusted() if 0 < size < math.inf else 0
