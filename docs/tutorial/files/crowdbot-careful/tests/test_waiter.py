from crowdbot_careful.waiter import WAITER

from crowdbot.testing import parametrize_with_checks


@parametrize_with_checks([WAITER])
def test_conformance(check):
    check()
