from crowdbot.testing import components_of, parametrize_with_checks


@parametrize_with_checks(components_of("careful"))
def test_conformance(check):
    check()
