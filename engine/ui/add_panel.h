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

    // Enter confirms the choice, Up and Down move in the list. Takes effect at the next drawing, so
    // that text typed before counts.
    void press(Key key);

    // Describes the dialog to the overlay library. Returns the person's request, still without a
    // position, and then closes the dialog.
    std::optional<AddEdit> draw(const AtomDirectory& atoms);

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
    bool has_own_name_ = false;  // the person typed the name
    bool wants_focus_ = false;   // the first field gets the keyboard
    bool wants_add_ = false;
    int list_steps_ = 0;  // pending moves in the list, positive downwards
};

// The first of base2, base3, ... that no molecule has.
std::string find_free_name(const AtomDirectory& atoms, const std::string& base);

}  // namespace palpa
