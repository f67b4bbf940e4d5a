// A modal question over the picture.
#pragma once
#include "window/window.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct Answer {
    Key key;           // key that gives the answer
    std::string text;  // text of its button, with the key
    std::function<void()> then{};
};

struct Question {
    std::string text;
    std::vector<Answer> answers;
};

// The answer for a key; null: none.
const Answer* find_answer(const Question& question, Key key);

// Describes the question to the overlay library; returns the answer whose button was pressed, or
// null.
const Answer* draw_question(const Question& question);

}  // namespace palpa
