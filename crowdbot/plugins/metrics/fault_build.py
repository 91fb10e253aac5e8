"""Scoring of contacts that the robot causes, and contacts per distance."""

from __future__ import annotations

from collections.abc import Sequence

from crowdbot.plugin import References, Score, Trajectories, path_length
from crowdbot.plugin.for_metrics import FaultRule, at_fault, person_contacts, robot_of
from crowdbot.plugins.metrics.common_reference_build import way_made_good
from crowdbot.plugins.metrics.declared_build import RobotMetric, UndefinedError
from crowdbot.plugins.metrics.fault import ContactsAtFaultSpec, ContactsPerKmSpec
from crowdbot.plugins.metrics.safe_efficiency import SafeEfficiencySpec

#: Tolerance of the fault rule, m/s, so that rounding does not decide.
TOLERANCE = 1e-9
KILOMETRE = 1000.0


def fault_rule(spec: ContactsAtFaultSpec | ContactsPerKmSpec | SafeEfficiencySpec) -> FaultRule:
    """Return the rule of fault from the fields of a metric."""
    return FaultRule(
        speed=spec.fault_speed + TOLERANCE,
        reaction=spec.fault_reaction,
        braking=spec.fault_braking,
        margin=spec.fault_margin,
    )


class ContactsAtFault(RobotMetric[ContactsAtFaultSpec]):
    """Scores ``contacts_at_fault``: contacts by fault of the robot and of people.

    It is the robot's if it moves towards the person it touches and did not brake in time.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        spec = self.spec
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        robot = int(at_fault(run, found, fault_rule(spec), spec.jump_speed).sum())
        return [self.factory.ok("corrected", robot), self.factory.ok("person", len(found) - robot)]


class ContactsPerKm(RobotMetric[ContactsPerKmSpec]):
    """Scores ``contacts_per_km``: contacts per kilometre of progress and of driven path.

    All contacts and those at fault per progress, all per driven distance; and both distances. Needs
    a goal, except for ``driven``.
    """

    def _scores(self, run: Trajectories, _: References) -> Sequence[Score]:
        spec = self.spec
        found = person_contacts(run, spec.jump_speed, spec.contact_tol, spec.release_gap)
        fault = int(at_fault(run, found, fault_rule(spec), spec.jump_speed).sum())
        driven = path_length(run.t, robot_of(run), spec.jump_speed)
        of_path = self._rate("driven", len(found), driven), self._way("driven_way", driven)
        try:
            good = way_made_good(run)
        except UndefinedError as error:
            first, second, way = self.factory.all_undefined(
                str(error), ("corrected", "at_fault", "way")
            )
            return [first, second, of_path[0], way, of_path[1]]
        return [
            self._rate("corrected", len(found), good),
            self._rate("at_fault", fault, good),
            of_path[0],
            self._way("way", good),
            of_path[1],
        ]

    def _way(self, variant: str, way: float) -> Score:
        """Score the distance by which the rates are divided."""
        return self.factory.ok(variant, max(way, self.spec.least_way) / KILOMETRE)

    def _rate(self, variant: str, count: int, way: float) -> Score:
        """Score contacts per kilometre; undefined without progress, unless there was contact."""
        least = self.spec.least_way
        if not count and way < least - TOLERANCE:
            return self.factory.undefined(variant, "zero_denominator")
        extras = {"contacts": float(count), "way": way}
        return self.factory.ok(variant, KILOMETRE * count / max(way, least), extras)
