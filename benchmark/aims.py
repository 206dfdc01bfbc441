"""What was aimed at, and whether the measurement reaches it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from measure import Result

LM, CONFORMAL, ADAM, ADAM_CONFORMAL = "gaik LM", "gaik LM, conformal", "gaik Adam", "gaik Adam, conformal"
SHARE = {"T1": 0.5, "T2": 0.2, "T3": 0.5}
"""Of the best peer's time."""
OWN_TYPES = ", own types"
"""The mark of a peer's second time, without the conversions from and to NumPy that a program pays for."""


@dataclass(frozen=True)
class Aim:
    """An aim with what was measured."""

    text: str
    measured: str
    met: bool


def aims(key: str, results: Sequence[Result]) -> list[Aim]:
    """The aims of one task."""
    ours = {result.name: result for result in results if result.package == "gaik_core"}
    peers = [r for r in results if r.package != "gaik_core" and not r.name.endswith(OWN_TYPES)]
    found: list[Aim] = []
    if key == "T4":
        return _batch(ours, peers)
    if key.startswith("T5"):
        return [_faster_than_all(key, ours["gaik"], peers)] if peers else []
    if key in SHARE and peers and LM in ours:
        best = min(peers, key=lambda peer: peer.ratio(ours[LM]))
        share = ours[LM].ratio(best)
        text = f"{key}: LM takes at most {SHARE[key]:g} of the best peer's time"
        found.append(Aim(text, f"{share:.2f} of {best.name}'s", share <= SHARE[key]))
    if key == "T1" and peers and ADAM in ours:
        found.append(_faster_than_all("T1, the paper's Adam", ours[ADAM], peers))
    if key == "T2p" and LM in ours:
        solved, time = ours[LM].solved, ours[LM].median * 1e3
        text = "T2p: at least 99.5 % of the poses, under 5 ms each"
        found.append(Aim(text, f"{100 * solved:.1f} %, {time:.3f} ms", solved >= 0.995 and time < 5.0))
    if key == "T2" and LM in ours:
        solved = ours[LM].solved
        found.append(Aim("T2: at least 99.9 % of the positions", f"{100 * solved:.1f} %", solved >= 0.999))
    for plain, other in ((LM, CONFORMAL), (ADAM, ADAM_CONFORMAL)):
        if plain in ours and other in ours:
            found.append(_at_most_twice(key, ours[other], ours[plain]))
    return found


def _batch(ours: dict[str, Result], peers: Sequence[Result]) -> list[Aim]:
    found = []
    for name, result in ours.items():
        if name.endswith(", conformal"):
            found.append(_at_most_twice("T4", result, ours[name.removesuffix(", conformal")]))
        elif peers:
            wanted = 50 if name.endswith("1 core") else 100
            best = min(peers, key=lambda peer: peer.ratio(result))
            ratio = best.ratio(result)
            text = f"T4: {name} has at least {wanted} times the best peer's throughput"
            found.append(Aim(text, f"{ratio:.1f} times {best.name}'s", ratio >= wanted))
        share = f"{100 * result.solved:.2f} %"
        found.append(Aim(f"T4: {name} solves at least 99.9 %", share, result.solved >= 0.999))
    return found


def _faster_than_all(what: str, ours: Result, peers: Sequence[Result]) -> Aim:
    best = min(peers, key=lambda peer: peer.ratio(ours))
    ratio = best.ratio(ours)
    return Aim(f"{what}: ahead of every peer", f"{best.name} takes {ratio:.2f} times as long", ratio > 1.0)


def _at_most_twice(key: str, conformal: Result, plain: Result) -> Aim:
    ratio = conformal.ratio(plain)
    return Aim(
        f"{key}: {conformal.name} takes at most twice {plain.name}'s time", f"{ratio:.2f} times", ratio <= 2.0
    )
