"""Options that are not repeatable refuse to be given twice, since one value would be lost."""

from __future__ import annotations

from typing import Any

#: Actions of a parser's options that keep the last value only.
_KEEP_LAST = ("store", "store_const")


def refuse_repetition(command: Any) -> None:
    """Make each option of a command that is not repeatable a usage error if given twice."""
    usual = command.make_parser

    def make_parser(context: Any) -> Any:
        parser = usual(context)
        for option in {*parser._short_opt.values(), *parser._long_opt.values()}:
            if option.action in _KEEP_LAST:
                _watch(option, context)
        return parser

    command.make_parser = make_parser


def _watch(option: Any, context: Any) -> None:
    usual = option.process

    def process(value: Any, state: Any) -> None:
        if option.dest in state.opts:
            names = "/".join([*option.obj.opts, *option.obj.secondary_opts])
            given = f": '{state.opts[option.dest]}' and '{value}'" if option.takes_value else ""
            context.fail(f"{names} is given twice{given}; it is not repeatable")
        usual(value, state)

    option.process = process
