#include "app/open_structure.h"

#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "experiments/make_scene.h"
#include "scene/find_scene.h"
#include "ui/file_browser.h"
#include "ui/layout.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace palpa {
namespace {

namespace fs = std::filesystem;

constexpr double page_frames_per_s = 60;

bool has_ending(const fs::path& file, std::span<const std::string_view> endings) {
    return std::ranges::find(endings, upper_case(file.extension().string())) != endings.end();
}

// Beside the topology, of the same name.
fs::path find_coordinates(const fs::path& topology) {
    for (const char* const ending : {".crd", ".cor", ".pdb", ".cif"}) {
        fs::path file = fs::path(topology).replace_extension(ending);
        std::error_code error;
        if (fs::exists(file, error)) return file;
    }
    throw LoadError({topology.string()},
                    fmt::format("has no coordinates; expected {0}.crd or {0}.pdb beside it, or "
                                "both files dropped together",
                                topology.stem().string()));
}

SceneRequest build_request(std::span<const fs::path> files) {
    constexpr std::array<std::string_view, 6> of_force_field{".STR", ".RTF", ".PRM",
                                                             ".TOP", ".PAR", ".INP"};
    constexpr std::array<std::string_view, 3> of_ligands{".SDF", ".MOL", ".MOL2"};
    SceneRequest request;
    request.settings.solvent.reset();  // implicit water where it covers everything
    for (const fs::path& file : files) {
        if (is_topology(file)) {
            request.topology = file;
        } else if (has_ending(file, of_force_field)) {
            request.force_field.push_back(file);
        } else if (has_ending(file, of_ligands)) {
            request.settings.ligand_files.push_back(file);
            request.settings.approximates_ligands = true;
        } else if (request.structure.empty()) {
            request.structure = file;
        } else {
            throw LoadError(
                {file.string()},
                fmt::format("is a second structure file; expected one at a time (the first was {})",
                            request.structure.filename().string()));
        }
    }
    if (request.structure.empty() && !request.topology.empty())
        request.structure = find_coordinates(request.topology);
    if (request.structure.empty()) {
        throw LoadError({files.empty() ? std::string() : files[0].string()},
                        "is not a structure file; expected .pdb, .cif or .crd, and with it, if "
                        "needed, its topology (.psf) or a parameter file of its ligands (.str)");
    }
    request.settings.entry = request.structure;
    return request;
}

// NAME, NAME-2 and so on, of which there is none.
fs::path find_free_folder(const fs::path& below, const fs::path& structure) {
    fs::path name = name_of_structure(structure);
    if (name.empty()) name = "structure";
    for (int number = 1;; ++number) {
        fs::path folder =
            below / (number == 1 ? name.string() : fmt::format("{}-{}", name.string(), number));
        std::error_code error;
        if (!fs::exists(folder, error)) return folder;
    }
}

// With an English title.
void begin_page(const char* title) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float edge = panel_edge();
    const ImVec2 size{std::min(scaled(820), screen.x - 2 * edge),
                      std::min(scaled(700), screen.y - 2 * edge)};
    ImGui::SetNextWindowPos({0.5F * (screen.x - size.x), 0.5F * (screen.y - size.y)});
    ImGui::SetNextWindowSize(size);
    ImGui::Begin(labelled(title).c_str(), nullptr, fixed_panel | ImGuiWindowFlags_NoCollapse);
}

// Leaves room for a row of buttons below.
void draw_long_text(const std::string& text) {
    ImGui::BeginChild("##text", {0, -2 * ImGui::GetFrameHeightWithSpacing()}, true);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
}

// What is done about residues that the force field lacks.
enum class Remedy { None, Omit, Approximate, Files };

class UnknownPage {
public:
    // `problem`: of the files that were tried last; `folder`: where to look for others.
    UnknownPage(WindowShell& shell, std::span<const UnknownResidue> residues, bool may_approximate,
                const std::string& problem, fs::path folder)
        : shell_(shell),
          residues_(residues),
          may_approximate_(may_approximate),
          problem_(problem),
          folder_(std::move(folder)) {}

    Remedy run(std::vector<fs::path>& files) {
        shell_.run(page_frames_per_s, [this] { return frame(); }, [] {});
        files.insert(files.end(), files_.begin(), files_.end());
        return remedy_.value_or(Remedy::None);
    }

private:
    bool frame() {
        if (shell_.window().should_close()) return false;
        for (const KeyPress& press : shell_.poll().pressed) take(press.key);
        shell_.draw_panels([this] { draw(); });
        return !remedy_;
    }

    void take(Key key) {
        if (browser_.is_open()) {
            key == Key::Escape ? browser_.close() : browser_.press(key);
            return;
        }
        if (key == Key::Escape) remedy_ = Remedy::None;
        if (key == Key::L) remedy_ = Remedy::Omit;
        if (key == Key::A && may_approximate_) remedy_ = Remedy::Approximate;
        if (key == Key::P) browse();
    }

    void browse() {
        browser_.open(translated("Parameters of a ligand (CHARMM stream file)"),
                      {".str", ".rtf", ".prm"}, folder_);
    }

    void draw() {
        begin_page(for_translation("Not in the force field"));
        std::string text = problem_.empty() ? std::string() : problem_ + "\n\n";
        for (const UnknownResidue& one : residues_) {
            text += format_translated(
                "{}{}: {} atoms; found {} times ({})\n{}\n", one.name,
                one.meaning.empty() ? "" : fmt::format(" ({})", one.meaning), one.atoms,
                one.where.size(),
                fmt::join(one.where.begin(),
                          one.where.begin() + std::min<std::ptrdiff_t>(4, std::ssize(one.where)),
                          ", "),
                advise(one, AdviceFor::Window));
        }
        text += translated(
            "Leave them out: Palpa prepares the structure without these residues.\nApproximate: "
            "Palpa takes types, charges and parameters from similar known residues. This is good "
            "enough to feel the shape, but not to measure.\nParameter file: choose a CHARMM stream "
            "file (.str) that defines the residue. The CGenFF server (cgenff.com) writes one.");
        draw_long_text(text);
        if (ImGui::Button(labelled("Leave them out (L)").c_str())) remedy_ = Remedy::Omit;
        ImGui::SameLine();
        ImGui::BeginDisabled(!may_approximate_);
        if (ImGui::Button(labelled("Approximate (A)").c_str())) remedy_ = Remedy::Approximate;
        ImGui::EndDisabled();
        ImGui::SameLine();
        if (ImGui::Button(labelled("Parameter file... (P)").c_str())) browse();
        ImGui::SameLine();
        if (ImGui::Button(labelled("Cancel (Esc)").c_str())) remedy_ = Remedy::None;
        ImGui::End();
        if (const std::optional<fs::path> file = browser_.draw()) {
            files_.push_back(*file);
            remedy_ = Remedy::Files;
        }
    }

    WindowShell& shell_;
    std::span<const UnknownResidue> residues_;
    bool may_approximate_;
    const std::string& problem_;
    const fs::path folder_;
    FileBrowser browser_;
    std::vector<fs::path> files_;
    std::optional<Remedy> remedy_;
};

// Whether the person goes on to the scene.
bool show_report(WindowShell& shell, const std::string& text, bool has_scene) {
    std::optional<bool> goes_on;
    const auto draw = [&] {
        begin_page(for_translation("What Palpa decided"));
        draw_long_text(text);
        ImGui::BeginDisabled(!has_scene);
        if (ImGui::Button(labelled("Feel it (Enter)").c_str())) goes_on = true;
        ImGui::EndDisabled();
        ImGui::SameLine();
        if (ImGui::Button(labelled("Back (Esc)").c_str())) goes_on = false;
        ImGui::End();
    };
    shell.run(
        page_frames_per_s,
        [&] {
            if (shell.window().should_close()) return false;
            for (const KeyPress& press : shell.poll().pressed) {
                if (press.key == Key::Enter && has_scene) goes_on = true;
                if (press.key == Key::Escape) goes_on = false;
            }
            shell.draw_panels(draw);
            return !goes_on;
        },
        [] {});
    return goes_on.value_or(false);
}

void apply(Remedy remedy, std::span<const UnknownResidue> residues, PrepareSettings& settings) {
    if (remedy == Remedy::Approximate) settings.approximates_ligands = true;
    if (remedy != Remedy::Omit) return;
    for (const UnknownResidue& one : residues) settings.without.push_back(one.name);
}

// Nothing where it was cancelled. Of parameter files that are wrong the page says so and asks
// again.
std::optional<MadeScene> make_with_remedies(WindowShell& shell, SceneRequest request) {
    const std::string title =
        format_translated("Preparing {}", request.structure.filename().string());
    std::optional<UnknownResidues> unknown;
    std::vector<fs::path> tried;  // files that the person chose last
    for (;;) {
        MadeScene made;
        bool lacks_something = false;
        std::string problem;
        const bool is_done = shell.work(title, [&](const StageFunction& on_stage) {
            try {
                made = make_scene(request, on_stage);
            } catch (const UnknownResidues& error) {
                lacks_something = true;
                unknown = error;
            } catch (const LoadError& error) {
                if (tried.empty()) throw;
                problem = error.what();
            }
        });
        if (!is_done) return std::nullopt;
        if (!lacks_something && problem.empty()) return made;
        if (!unknown->is_all()) throw LoadError(*unknown);
        if (!problem.empty()) {
            std::erase_if(request.force_field, [&](const fs::path& file) {
                return std::ranges::find(tried, file) != tried.end();
            });
        } else if (!tried.empty()) {
            problem =
                format_translated("{} does not define this residue; choose the file that does.",
                                  tried.front().filename().string());
        }
        tried.clear();
        const Remedy remedy =
            UnknownPage(shell, unknown->residues(), !request.settings.approximates_ligands, problem,
                        request.structure.parent_path())
                .run(tried);
        if (remedy == Remedy::None) return std::nullopt;
        apply(remedy, unknown->residues(), request.settings);
        request.force_field.insert(request.force_field.end(), tried.begin(), tried.end());
    }
}

}  // namespace

std::optional<fs::path> open_structure(WindowShell& shell, std::span<const fs::path> files,
                                       const fs::path& folder, const std::string& said) {
    const SceneRequest request = build_request(files);
    const std::optional<MadeScene> made = make_with_remedies(shell, request);
    if (!made) return std::nullopt;
    const fs::path results = find_free_folder(folder, request.structure);
    write_prepared(made->system, results, made->title, made->scene.files);
    const bool has_scene = !made->scene.files.empty();
    const std::size_t warnings = made->system.report.warnings().size();
    std::string text = said.empty() ? std::string() : said + "\n";
    text += format_translated("{} atoms. Written to {}", made->system.structure.names.size(),
                              results.string());
    text += "\n";
    text += has_scene ? format_translated("In your hand: {}.", made->scene.in_hand)
                      : std::string(translated(
                            "No scene could be made from this structure; see the warnings below."));
    text +=
        "\n" + fmt::format(fmt::runtime(translated_plural("{} warning.", "{} warnings.", warnings)),
                           warnings);
    text += "\n\n" + made->system.report.to_text();
    if (!show_report(shell, text, has_scene)) {
        std::error_code error;
        fs::remove_all(results, error);  // it was made just now
        return std::nullopt;
    }
    return results / "scene.toml";
}

}  // namespace palpa
