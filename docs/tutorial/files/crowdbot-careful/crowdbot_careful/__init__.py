from crowdbot.plugin import hookimpl

CROWDBOT_API = 1


@hookimpl
def crowdbot_components():
    return {"planner": ["crowdbot_careful.waiter:WAITER"]}
