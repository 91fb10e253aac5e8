"""The conformance kit: checks of components' contracts, for their own tests.

::

    from crowdbot.testing import components_of, parametrize_with_checks

    @parametrize_with_checks(components_of("acme"))
    def test_conformance(check):
        check()

`random_view` and `costs_at` are for tests of cost functions, `installed` for those of a plugin's
health. ``parametrize_with_checks`` needs pytest, `crowdbot.testing.strategies` hypothesis:
``pip install 'crowdbot[testing]'``. `checks_for` needs neither.
"""

from crowdbot.testing.around import components_of, installed
from crowdbot.testing.checks import bind, checks_for, checks_of
from crowdbot.testing.crowd_views import random_view
from crowdbot.testing.evaluated_costs import costs_at
from crowdbot.testing.parametrize import parametrize_with_checks

__all__ = [
    "bind",
    "checks_for",
    "checks_of",
    "components_of",
    "costs_at",
    "installed",
    "parametrize_with_checks",
    "random_view",
]
