"""What may be claimed of a plan, in words: no more than its proof shows."""

from tpss.planning.prove import Grade, Proof


def claim(proof: Proof, plans: int, gap: float = 1e-9) -> str:
    """The sentence of proof.

    Parameters
    ----------
    proof : Proof
    plans : int
        Number of plans there are.
    gap : float
        Share of the cost up to which a plan counts as the best.
    """
    if not proof.holds:
        return _withdrawn(proof)
    none = (
        f"Of all {counted(plans)} plans over these configurations, stages and scenarios none has a "
        "lower expected discounted cost"
    )
    if proof.solution.gap > gap:
        least = f"by more than {100.0 * proof.solution.gap:.2g} %"
        none = none.replace("has a lower", "lowers the") + f" {least}"
    return f"{none}{_ground(proof)}"


def _ground(proof: Proof) -> str:
    """Why it may be claimed, and under which condition."""
    some = f"{proof.simulated:,} of {proof.cases:,} cases were simulated"
    if proof.grade is Grade.EXHAUSTIVE or proof.simulated == proof.cases:
        return f": all {proof.cases:,} cases were simulated."
    words = f", if the lower ends of the approximator hold: {some}, and none is below its own."
    verb, verbs = "is", "are"
    if proof.grade is Grade.BOUNDED:
        words = f", if no case costs less than its bound: {some}, and none of them does."
        verb, verbs = "does", "do"
    if (rate := proof.fault_rate) is None:
        return words
    return (
        f"{words} Nor {verb} any of {proof.audited:,} that were drawn at random: at most "
        f"{100.0 * rate:.2g} % of all {verbs}, with 95 % confidence, which is a rate and no proof."
    )


def _withdrawn(proof: Proof) -> str:
    """Why nothing is claimed, and what to do."""
    worst = max(proof.violations, key=lambda each: each.bound - each.cost)
    return (
        f"Nothing is claimed of other plans: of {proof.simulated:,} simulated cases "
        f"{len(proof.violations):,} cost less than their bounds, one of them {worst.cost:.6g} a year "
        f"where the bound was {worst.bound:.6g}. Simulate all cases: tpss plan run --all."
    )


def counted(number: int) -> str:
    """A number of any size: whole up to a million, above in powers of ten."""
    if number < 1_000_000:
        return f"{number:,}"
    digits = str(number)
    return f"{digits[0]}.{digits[1]}·10^{len(digits) - 1}"
