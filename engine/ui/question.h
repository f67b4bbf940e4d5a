// A question over the picture that must be answered first.
#pragma once
#include "window/window.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct Answer {
    Key key;           // that gives it
    std::string text;  // on its button, with the key
    std::function<void()> then{};
};

struct Question {
    std::string text;
    std::vector<Answer> answers;
};

// The answer that a key gives; null: none.
const Answer* find_answer(const Question& question, Key key);

// Describes it to the overlay library; the answer whose button was pressed, or null.
const Answer* draw_question(const Question& question);

}  // namespace palpa
