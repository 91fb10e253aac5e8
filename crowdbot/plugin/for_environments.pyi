"""Names of this module, and where they come from: for type checkers, and to import them."""

__all__: list[str]

from crowdbot.core.geometry.valid_shape import valid_shape as valid_shape
from crowdbot.core.support.strict_json import DEEPEST as DEEPEST
from crowdbot.core.support.strict_json import parse_foreign_json as parse_foreign_json
from crowdbot.core.support.text_files import LARGEST_TABLE as LARGEST_TABLE
from crowdbot.core.support.text_files import input_bytes as input_bytes
from crowdbot.core.support.text_files import input_text as input_text
from crowdbot.dsl.text.plain_document import read_document as read_document
from crowdbot.errors import SpecError as SpecError
