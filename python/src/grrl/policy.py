"""Policies written in Python, through the interface of those in C (grrl/learner/policy.h)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

from . import _check, _native
from .model import Model, model_from

DIRECTIONS = _native.DIRECTIONS_DEG
_RULE, _ADOPTED = 4, 3


@dataclass(frozen=True)
class View:
    """What a policy sees of the world: what perception estimates, now.

    Attributes
    ----------
    model : Model
        In metres, with one body at least when there is a choice to make.
    """

    model: Model

    @property
    def n_links(self) -> int:
        return len(self.model.bodies)


@dataclass(frozen=True)
class Outcome:
    """What came of a choice.

    Attributes
    ----------
    view : View
        After the push.
    link : int
        Index of the body that was pushed, in the view of the choice.
    direction : int
        Index into `grrl.DIRECTIONS_DEG`.
    body : str
        "f3": of the body that was pushed, which may have split since.
    reward : float
        Links and joints revealed; at the trial's end also its reward.
    ended : bool
        The trial ended, and nothing follows.
    """

    view: View
    link: int
    direction: int
    body: str
    reward: float
    ended: bool


@runtime_checkable
class Policy(Protocol):
    """What decides which link to push in which direction. Only `choose` is required.

    A policy may also have `begin_trial()`, `learn(outcome: Outcome)`, `explain(view, link, direction)`
    (a value of the action, or None), and `save() -> bytes` with `load(bytes)`.
    """

    def choose(self, view: View, random: _native.Random) -> tuple[int, int]:
        """The link (an index into `view.model.bodies`) and the direction (an index into
        `grrl.DIRECTIONS_DEG`) of the next push. `random` gives the same numbers for the same seed:
        `random.below(n)`, `random.uniform()`."""
        ...


class Adapter:
    """A policy as the extension module calls it: with dictionaries, and with checked answers."""

    def __init__(self, policy: Policy) -> None:
        if not callable(getattr(policy, "choose", None)):
            raise TypeError("a policy needs choose(view, random), which returns (link, direction); "
                            f"{type(policy).__name__} has none")
        self.policy = policy

    def begin_trial(self) -> None:
        begin = getattr(self.policy, "begin_trial", None)
        if begin is not None:
            begin()

    def choose(self, raw: dict[str, Any], random: _native.Random) -> tuple[int, int, Any]:
        view = View(model_from(raw, "m"))
        answer = self.policy.choose(view, random)
        try:
            link, direction = answer
        except (TypeError, ValueError):
            raise TypeError(f"choose must return (link, direction), not {answer!r}") from None
        link = _check.whole(link, "the link of choose", 0, view.n_links - 1)
        direction = _check.whole(direction, "the direction of choose", 0, len(DIRECTIONS) - 1)
        return link, direction, self._words(_RULE, view, link, direction)

    def explain(self, raw: dict[str, Any], link: int, direction: int) -> Any:
        return self._words(_ADOPTED, View(model_from(raw, "m")), link, direction)

    def _words(self, reason: int, view: View, link: int, direction: int) -> Any:
        explain = getattr(self.policy, "explain", None)
        value = None if explain is None else explain(view, link, direction)
        value = 0.0 if value is None else _check.real(value, "the value of explain", -1e30, 1e30)
        return reason, value, value, value, 0.0

    def learn(self, raw: dict[str, Any], link: int, direction: int, number: int, reward: float,
              ended: bool) -> float:
        learn = getattr(self.policy, "learn", None)
        if learn is None:
            return reward
        target = learn(Outcome(View(model_from(raw, "m")), link, direction, f"f{number}", reward, ended))
        return reward if target is None else _check.real(target, "the target of learn", -1e30, 1e30)
