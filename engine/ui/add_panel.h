// The dialog "Add a molecule": a residue of the scene's force field, a copy of a molecule, or a
// molecule from files.
#pragma once
#include "scene/edits.h"
#include "simulation/atom_directory.h"
#include "window/window.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpa {

class AddPanel {
public:
    // `folder`: the scene's folder; file names are relative to it.
    explicit AddPanel(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Opens with the last choice, or, if the force field has no residues, with a copy of the held
    // molecule, if there is one.
    void open(const AtomDirectory& atoms, const std::string& in_hand);
    // Opens with these files; a .psf file is the topology.
    void open(std::span<const std::filesystem::path> files);
    void close();
    bool is_open() const noexcept { return is_open_; }

    // Enter asks for what is chosen, with Shift to have it in hand; Up and Down choose in the list;
    // when it is drawn the next time, so that what was typed before counts.
    void press(const KeyPress& press);

    // Describes the dialog to the overlay library. Returns the person's request, still without a
    // position, and then closes the dialog.
    std::optional<AddEdit> draw(const AtomDirectory& atoms);
    // Whether what was asked for last goes into the hand.
    bool takes() const noexcept { return takes_; }

private:
    enum class Origin { Residue, Copy, Files };

    void open();
    void choose_origin(Origin origin, const char* text);
    void choose_residue(const AtomDirectory& atoms);
    void choose_copy(const AtomDirectory& atoms);
    void choose_files();
    void choose_from(std::span<const std::string> names, std::string& chosen,
                     std::span<const std::string> texts);
    void name_it(const AtomDirectory& atoms);
    std::string find_base() const;
    std::filesystem::path path_of(const std::string& file) const;
    std::string find_problem(const AtomDirectory& atoms) const;
    AddEdit build_edit() const;

    std::filesystem::path folder_;
    bool is_open_ = false;
    Origin origin_ = Origin::Residue;
    std::string search_, residue_, copy_of_, structure_, topology_, segment_, name_;
    bool has_own_name_ = false;  // the person wrote it
    bool wants_focus_ = false;   // for the first field
    bool wants_add_ = false, wants_take_ = false, takes_ = false;
    int list_steps_ = 0;  // down
};

// The first of base2, base3, ... that no molecule has.
std::string find_free_name(const AtomDirectory& atoms, const std::string& base);

}  // namespace palpa
