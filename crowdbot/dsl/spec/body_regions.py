"""Names for the stiffness of the human body's regions.

The values are the effective spring constants of the body model of ISO/TS 15066:2016, annex A, table
A.3, based on BG/BGIA recommendations U 001/2009. They were not checked against the standard, which
is not free; sources: docs/reference/robots.md.
"""

from __future__ import annotations

from typing import Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from crowdbot.errors import did_you_mean, nearest

#: Region -> stiffness, N/m.
STIFFNESS = {
    "skull": 150e3,
    "face": 75e3,
    "neck": 50e3,
    "back": 35e3,
    "chest": 25e3,
    "abdomen": 10e3,
    "pelvis": 25e3,
    "upper_arm": 30e3,
    "lower_arm": 40e3,
    "hand": 75e3,
    "thigh": 50e3,
    "lower_leg": 60e3,
}


class BodyRegion:
    """Annotation that lets a stiffness accept the name of a body region."""

    def __get_pydantic_core_schema__(
        self, source: type[Any], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        quantity = handler(source)
        words = core_schema.literal_schema(list(STIFFNESS))
        return core_schema.no_info_before_validator_function(
            self.parse,
            quantity,
            json_schema_input_schema=core_schema.union_schema([quantity, words]),
        )

    @staticmethod
    def parse(value: object) -> object:
        """Return the stiffness of a region (N/m); other values are unchanged.

        Raises:
            PydanticCustomError: ``quantity``, the word is not a region.
        """
        if not isinstance(value, str) or not value.isidentifier():
            return value
        if value in STIFFNESS:
            return STIFFNESS[value]
        raise PydanticCustomError(
            "quantity",
            "'{text}' is neither a quantity of {dimension} nor a body region (regions: {units})",
            {
                "text": value,
                "dimension": "stiffness",
                "units": ", ".join(STIFFNESS),
                "hint": did_you_mean(nearest(value, STIFFNESS, 1)).removeprefix("; "),
            },
        )
