"""The conformance kit: what every component must keep to, as checks for its own tests.

::

    from crowdbot.testing import parametrize_with_checks

    @parametrize_with_checks([OMNI, COMFORT])
    def test_conformance(check):
        check()

``parametrize_with_checks`` needs pytest, `crowdbot.testing.strategies` hypothesis:
``pip install crowdbot[testing]``. `checks_for` needs neither.
"""

from crowdbot.testing.checks import bind, checks_for, checks_of
from crowdbot.testing.parametrize import parametrize_with_checks

__all__ = ["bind", "checks_for", "checks_of", "parametrize_with_checks"]
