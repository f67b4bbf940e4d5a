"""The lessons of whole proteins: a hand that holds still or wanders does not do them."""
import unittest

from lessons_test import LONG, check_that_it_is_not_done


class LongLessons(unittest.TestCase):
    def test_a_hand_that_knows_nothing_does_none(self):
        for name in LONG:
            check_that_it_is_not_done(self, name)


if __name__ == "__main__":
    unittest.main()
