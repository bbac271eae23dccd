"""Long tests of many cases take turns: of each commit every fifth case, and of five commits all of them.

scripts/test sets TWINMAP_TEST_SEED to the commit (hexadecimal), which says whose turn it is and seeds what is drawn at
random; without it the first fifth is taken. `ctest -L long` sets TWINMAP_ALL_CASES, and takes all. Tests in C++ have
tests/case_turns.hpp.
"""
import os

TURNS = 5
ALL_CASES = bool(os.environ.get("TWINMAP_ALL_CASES"))
SEED = os.environ.get("TWINMAP_TEST_SEED", "0")


def say_whose_turn_it_is():
    """For the output of a test that fails."""
    print(f"TWINMAP_TEST_SEED={SEED}" + (" TWINMAP_ALL_CASES=1" if ALL_CASES else ""), "repeats this")


def take_turn(cases):
    """Every fifth of the cases, or all."""
    say_whose_turn_it_is()
    return list(cases) if ALL_CASES else list(cases)[int(SEED, 16) % TURNS :: TURNS]


def count_turn(cases):
    """A fifth of a number of cases that are drawn, or all."""
    say_whose_turn_it_is()
    return cases if ALL_CASES else cases // TURNS
