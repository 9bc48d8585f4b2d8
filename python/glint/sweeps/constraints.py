# Reads constraints between keys ("rt.warps <= core.warps") and says which points keep them.
# SPDX-License-Identifier: Apache-2.0
"""`Constraint(text).holds(values)` evaluates an expression over keys. It can do arithmetic and comparisons, and nothing else."""
from __future__ import annotations

import ast
import math
import operator
from typing import Any, Mapping

from ..errors import SweepError
from ..patterns import near

_BINARY = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.FloorDiv: operator.floordiv, ast.Mod: operator.mod}
_COMPARE = {ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge, ast.Eq: operator.eq, ast.NotEq: operator.ne}
_FUNCTIONS = {"min": min, "max": max, "abs": abs, "log2": math.log2}


class Constraint:
    """Holds one expression, whose names are configuration keys, and `workload`, `config` and `seed`."""

    def __init__(self, text: str):
        self.text = text
        try:
            self._tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError, AttributeError) as error:
            raise SweepError(f"the constraint {text!r} cannot be read: {error}") from error

    def holds(self, values: Mapping[str, Any]) -> bool:
        """Returns whether a point keeps it. Raises SweepError for a name that is no key, and for what cannot be computed."""
        try:
            return bool(self._value(self._tree, values))
        except (TypeError, ValueError, ArithmeticError, RecursionError, MemoryError) as error:
            raise SweepError(f"the constraint {self.text!r} cannot be computed: {error}") from error

    def _value(self, node: ast.AST, values: Mapping[str, Any]) -> Any:
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
            return node.value
        if isinstance(node, (ast.Name, ast.Attribute)):
            return self._key(ast.unparse(node), values)
        if isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
            return _BINARY[type(node.op)](self._value(node.left, values), self._value(node.right, values))
        if isinstance(node, ast.UnaryOp):
            value = self._value(node.operand, values)
            return not value if isinstance(node.op, ast.Not) else -value if isinstance(node.op, ast.USub) else value
        if isinstance(node, ast.BoolOp):
            check = all if isinstance(node.op, ast.And) else any
            return check(self._value(one, values) for one in node.values)
        if isinstance(node, ast.Compare) and all(type(op) in _COMPARE for op in node.ops):
            terms = [self._value(one, values) for one in (node.left, *node.comparators)]
            return all(_COMPARE[type(op)](left, right) for op, left, right in zip(node.ops, terms, terms[1:]))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _FUNCTIONS and not node.keywords:
            return _FUNCTIONS[node.func.id](*(self._value(one, values) for one in node.args))
        raise SweepError(f"the constraint {self.text!r} has '{ast.unparse(node)}': it may have keys, numbers, texts, + - * / // %, comparisons, and, or, not, {', '.join(_FUNCTIONS)}")

    def _key(self, name: str, values: Mapping[str, Any]) -> Any:
        if name == "true" or name == "false":
            return name == "true"
        if name not in values:
            raise SweepError(f"the constraint {self.text!r} names '{name}', which is no key{near(name, values)}")
        return values[name]
