from crowdbot.plugin import hookimpl
from crowdbot_careful.waiter import WAITER

CROWDBOT_API = 1


@hookimpl
def crowdbot_planners():
    return [WAITER]
