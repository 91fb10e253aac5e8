"""The conformance kit: what every component must keep to, as checks for its own tests.

::

    from crowdbot.testing import parametrize_with_checks

    @parametrize_with_checks([OMNI, COMFORT])
    def test_conformance(check):
        check()

Needs pytest and hypothesis: ``pip install crowdbot[testing]``.
"""

from crowdbot.testing.parametrize import checks_of, parametrize_with_checks

__all__ = ["checks_of", "parametrize_with_checks"]
