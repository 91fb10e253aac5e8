"""Metrics of the CrowdBot challenge (D7.3, sections 1.2 and 2.2), and the field's."""

from crowdbot.plugins.metrics import (
    clearance,
    collision,
    contact,
    crowd_effect,
    motion,
    overtaking,
    path_efficiency,
    planner_time,
    proximity,
    questionnaire,
    reference_path,
    risk,
    shared_control,
    similarity,
    task,
    walls,
)

COMPONENTS = (
    *path_efficiency.COMPONENTS,
    *crowd_effect.COMPONENTS,
    *risk.COMPONENTS,
    *collision.COMPONENTS,
    *similarity.COMPONENTS,
    *overtaking.COMPONENTS,
    *proximity.COMPONENTS,
    *clearance.COMPONENTS,
    *shared_control.COMPONENTS,
    *questionnaire.COMPONENTS,
    *task.COMPONENTS,
    *motion.COMPONENTS,
    *reference_path.COMPONENTS,
    *contact.COMPONENTS,
    *walls.COMPONENTS,
    *planner_time.COMPONENTS,
)
