from mutants import MUTANTS, chosen


def test_every_mutant_changes_one_place_of_the_code_as_it_is():
    assert len(chosen(MUTANTS)) >= 60
