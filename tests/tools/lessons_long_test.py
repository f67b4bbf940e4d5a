"""The lessons of whole proteins: the emulated operator does them, a hand that holds still or wanders
does not."""
import unittest

from lessons_test import DEVICES, LONG, check_that_it_is_not_done, check_that_the_operator_does_it, lessons


class LongLessons(unittest.TestCase):
    def test_the_operator_does_every_step(self):
        for lesson in lessons():
            for device in DEVICES:
                if lesson["name"] in LONG:
                    # On two of five ways by mouse the drug sits askew in the end, and stays so.
                    check_that_the_operator_does_it(self, lesson, device, range(1, 6) if device == "mouse" else (1,))

    def test_a_hand_that_knows_nothing_does_none(self):
        for name in LONG:
            check_that_it_is_not_done(self, name)


if __name__ == "__main__":
    unittest.main()
