from mutants import MUTANTS, chosen


def test_every_mutant_changes_one_place_of_the_code_as_it_is():
    assert len(chosen(MUTANTS)) >= 60


def test_no_mutant_is_counted_twice():
    for module, mutants in MUTANTS.items():
        assert len(set(mutants)) == len(mutants), module
