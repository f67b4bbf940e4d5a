// Interprets the script statements between the parts of a CHARMM stream file.
#pragma once
#include "charmm/force_field.h"
#include "charmm/statements.h"

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpa {

// Follows what charmm/force_field.h says of script statements. They stand outside of parts (behind
// END, or before the first line of topology or parameters).
class Script {
public:
    Script(Statements& statements, ForceField& into) : statements_(statements), into_(into) {}

    static bool is_script(std::string_view keyword);

    // Follows the present statement, which is_script; jumps and blocks that are not taken move on
    // to their end. False at RETURN: nothing behind it is read.
    bool follow();

    // Notes that a file which is named here must be given by itself.
    void note_other_file();

    // Throws LoadError at the end of a file inside of IF.
    void check_closed() const;

private:
    using Words = std::span<const std::string_view>;
    bool follow(Words words);
    bool follow_if(Words words);
    void set(Words words);
    void skip_block(bool stops_at_else);
    void go_to(std::string label);

    // The value of a word with its variables put in; nothing where CHARMM alone knows it.
    std::optional<std::string> find_value(std::string_view word) const;
    std::optional<bool> find_truth(Words words) const;

    Statements& statements_;
    ForceField& into_;
    std::map<std::string, std::optional<std::string>, std::less<>> variables_;  // unset: unknown
    std::vector<std::size_t> open_blocks_;  // lines of open IF blocks
};

}  // namespace palpa
