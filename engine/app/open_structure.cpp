#include "app/open_structure.h"

#include "app/scene_cards.h"
#include "core/files.h"
#include "core/load_error.h"
#include "core/text.h"
#include "core/translate.h"
#include "experiments/make_scene.h"
#include "formats/structure.h"
#include "prepare/report.h"
#include "prepare/summary.h"
#include "scene/find_scene.h"
#include "ui/file_browser.h"
#include "ui/layout.h"
#include "view/orbit_camera.h"
#include "view/preview.h"
#include "view/worded_picture.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
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

bool is_of_force_field(const fs::path& file) {
    return has_ending(
        file, std::array<std::string_view, 6>{".STR", ".RTF", ".PRM", ".TOP", ".PAR", ".INP"});
}

bool is_of_ligand(const fs::path& file) {
    return has_ending(file, std::array<std::string_view, 3>{".SDF", ".MOL", ".MOL2"});
}

SceneRequest build_request(std::span<const fs::path> files) {
    SceneRequest request;
    request.settings.solvent.reset();  // implicit water where it covers everything
    for (const fs::path& file : files) {
        if (is_topology(file)) {
            request.topology = file;
        } else if (is_of_force_field(file)) {
            request.force_field.push_back(file);
        } else if (is_of_ligand(file)) {
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
    request.measures = false;
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

constexpr float page_share = 0.42F;  // of the window, beside the picture

// Runs until `is_over`, or until the person closes the window.
void run_page(WindowShell& shell, const std::function<void(Key)>& press,
              const std::function<void()>& draw, const std::function<bool()>& is_over) {
    shell.run(
        page_frames_per_s,
        [&] {
            for (const KeyPress& one : shell.poll().pressed) press(one.key);
            shell.draw_panels(draw);
            return !shell.window().should_close() && !is_over();
        },
        [] {});
}

// Begins a page with an English title, at the right; `is_long`: down to the edge of the window.
void begin_page(const char* title, bool is_long) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float edge = panel_edge(), width = page_share * screen.x - edge;
    ImGui::SetNextWindowPos({screen.x - width - edge, edge});
    ImGui::SetNextWindowSize({width, is_long ? screen.y - 2 * edge : 0});
    ImGui::Begin(labelled(title).c_str(), nullptr, fixed_panel | ImGuiWindowFlags_NoCollapse);
}

// Leaves room for two rows of buttons below.
void draw_long_text(const std::string& text) {
    ImGui::BeginChild("##text", {0, -2.2F * ImGui::GetFrameHeightWithSpacing()}, true);
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
        run_page(
            shell_, [this](Key key) { take(key); }, [this] { draw(); },
            [this] { return remedy_.has_value(); });
        files.insert(files.end(), files_.begin(), files_.end());
        return remedy_.value_or(Remedy::None);
    }

private:
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
        begin_page(for_translation("Not in the force field"), true);
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
        const auto offer = [&](const char* text, Remedy remedy, bool is_possible = true) {
            same_line_if_it_fits(translated(text));
            ImGui::BeginDisabled(!is_possible);
            const bool is_pressed = ImGui::Button(labelled(text).c_str());
            if (is_pressed && remedy == Remedy::Files) browse();
            if (is_pressed && remedy != Remedy::Files) remedy_ = remedy;
            ImGui::EndDisabled();
        };
        if (ImGui::Button(labelled("Leave them out (L)").c_str())) remedy_ = Remedy::Omit;
        offer(for_translation("Approximate (A)"), Remedy::Approximate, may_approximate_);
        offer(for_translation("Parameter file... (P)"), Remedy::Files);
        offer(for_translation("Cancel (Esc)"), Remedy::None);
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

// Asks which of the offers to hold. Nothing: the person changed their mind.
std::optional<std::size_t> ask_for_hand(WindowShell& shell, const Structure& structure,
                                        const std::vector<HandOffer>& offers) {
    std::size_t chosen = 0;
    std::optional<bool> goes_on;
    const auto choose = [&](std::size_t offer) {
        chosen = std::min(offer, offers.size() - 1);
        shell.show_behind(build_preview(structure, offers[chosen].atoms), 1 - page_share);
    };
    choose(0);
    const auto draw = [&] {
        begin_page(for_translation("What will you hold?"), false);
        ImGui::TextWrapped("%s",
                           translated("The picture shows it in green. In the scene a click on "
                                      "an atom takes something else."));
        ImGui::Spacing();
        for (std::size_t i = 0; i < offers.size(); ++i) {
            const std::string text = i == 0
                                         ? format_translated("{} (Palpa's choice)", offers[i].words)
                                         : offers[i].words;
            ImGui::PushID(static_cast<int>(i));
            if (ImGui::RadioButton("##offer", i == chosen)) choose(i);
            ImGui::SameLine();
            ImGui::TextWrapped("%s", text.c_str());
            if (ImGui::IsItemClicked()) choose(i);
            ImGui::PopID();
        }
        ImGui::Spacing();
        if (ImGui::Button(labelled("Go on (Enter)").c_str())) goes_on = true;
        ImGui::SameLine();
        if (ImGui::Button(labelled("Cancel (Esc)").c_str())) goes_on = false;
        ImGui::End();
    };
    const auto press = [&](Key key) {
        if (key == Key::Enter) goes_on = true;
        if (key == Key::Escape) goes_on = false;
        if (key == Key::Down) choose(chosen + 1);
        if (key == Key::Up && chosen > 0) choose(chosen - 1);
    };
    run_page(shell, press, draw, [&] { return goes_on.has_value(); });
    if (!goes_on.value_or(false)) return std::nullopt;
    return chosen;
}

// The result in three lines, and all of it on request.
struct MadeReport {
    std::vector<std::string> lines{};
    std::string details{};
    bool has_scene = false;
};

// Whether the person goes on to the scene, or discards it; nothing: the window closes, or there is
// no scene.
std::optional<bool> show_report(WindowShell& shell, const MadeReport& report) {
    std::optional<bool> goes_on;
    bool shows_details = !report.has_scene;
    const auto draw = [&] {
        begin_page(for_translation("What Palpa made"), shows_details);
        for (const std::string& line : report.lines) ImGui::TextWrapped("%s", line.c_str());
        ImGui::Checkbox(labelled("Details (D)").c_str(), &shows_details);
        if (shows_details) draw_long_text(report.details);
        ImGui::BeginDisabled(!report.has_scene);
        if (ImGui::Button(labelled("Feel it (Enter)").c_str())) goes_on = true;
        ImGui::EndDisabled();
        ImGui::SameLine();
        const char* const leaves =
            report.has_scene ? for_translation("Discard it (Esc)") : for_translation("Back (Esc)");
        if (ImGui::Button(labelled(leaves).c_str())) goes_on = false;
        ImGui::End();
    };
    const auto press = [&](Key key) {
        if (key == Key::Enter && report.has_scene) goes_on = true;
        if (key == Key::Escape) goes_on = false;
        if (key == Key::D) shows_details = !shows_details;
    };
    run_page(shell, press, draw, [&] { return goes_on.has_value(); });
    return report.has_scene ? goes_on : std::nullopt;
}

void apply(Remedy remedy, std::span<const UnknownResidue> residues, PrepareSettings& settings) {
    if (remedy == Remedy::Approximate) settings.approximates_ligands = true;
    if (remedy != Remedy::Omit) return;
    for (const UnknownResidue& one : residues) settings.without.push_back(one.name);
}

std::vector<std::uint32_t> find_atoms_of(const Structure& structure,
                                         std::span<const UnknownResidue> residues) {
    std::vector<std::uint32_t> atoms;
    for (std::uint32_t atom = 0; atom < structure.names.size(); ++atom)
        if (std::ranges::count(residues, structure.names[atom].residue, &UnknownResidue::name) > 0)
            atoms.push_back(atom);
    return atoms;
}

// Returns nothing where it was cancelled. Of parameter files that are wrong the page says so and
// asks again.
std::optional<MadeScene> make_with_remedies(WindowShell& shell, const Structure& structure,
                                            SceneRequest request) {
    const std::string title =
        format_translated("Preparing {}", request.structure.filename().string());
    std::optional<UnknownResidues> unknown, asked;
    std::vector<fs::path> tried;  // files that the person chose last
    for (;;) {
        MadeScene made;
        bool lacks_something = false;
        std::string problem;
        const bool is_done = shell.work(title, [&](const StageFunction& on_stage) {
            try {
                made = prepare_request(request, on_stage);
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
        if (lacks_something && !unknown->is_all()) {
            if (!asked) throw LoadError(*unknown);
            problem = without_options(unknown->what());  // the remedy does not help
            unknown = asked;
        }
        asked = unknown;
        if (!problem.empty() && !tried.empty()) {
            std::erase_if(request.force_field, [&](const fs::path& file) {
                return std::ranges::find(tried, file) != tried.end();
            });
        } else if (!tried.empty()) {
            problem =
                format_translated("{} does not define this residue; choose the file that does.",
                                  tried.front().filename().string());
        }
        tried.clear();
        shell.show_behind(build_preview(structure, find_atoms_of(structure, unknown->residues())),
                          1 - page_share);
        const Remedy remedy =
            UnknownPage(shell, unknown->residues(), !request.settings.approximates_ligands, problem,
                        request.structure.parent_path())
                .run(tried);
        if (remedy == Remedy::None) return std::nullopt;
        shell.show_behind(build_preview(structure));
        apply(remedy, unknown->residues(), request.settings);
        request.force_field.insert(request.force_field.end(), tried.begin(), tried.end());
    }
}

// The picture behind the pages goes with them.
class PictureOfPages {
public:
    explicit PictureOfPages(WindowShell& shell) : shell_(shell) {}
    PictureOfPages(const PictureOfPages&) = delete;
    PictureOfPages& operator=(const PictureOfPages&) = delete;
    ~PictureOfPages() { shell_.show_behind({}); }

private:
    WindowShell& shell_;
};

// Returns nothing where it was cancelled.
std::optional<Structure> read_and_show(WindowShell& shell, const fs::path& file) {
    Structure structure;
    const bool is_done =
        shell.work(format_translated("Reading {}", file.filename().string()),
                   [&](const StageFunction& on_stage) {
                       structure = read_structure(file);
                       tell(on_stage, for_translation("reading the structure"));  // or cancelled
                   });
    if (!is_done) return std::nullopt;
    shell.show_behind(build_preview(structure));
    return structure;
}

// Lets the person choose, where there is a choice; nothing where they changed their mind.
std::optional<HandOffer> choose_hand_for(WindowShell& shell, const MadeScene& made, bool asks) {
    std::vector<HandOffer> offers;
    if (!shell.work(translated("Looking for what a hand may hold"),
                    [&](const StageFunction& /*on_stage*/) { offers = list_hands(made.system); }))
        return std::nullopt;
    if (offers.empty()) return HandOffer{};
    std::optional<std::size_t> chosen = 0;
    if (asks && offers.size() > 1) chosen = ask_for_hand(shell, made.system.structure, offers);
    if (!chosen) return std::nullopt;
    return std::move(offers[*chosen]);
}

MadeReport describe_made(const MadeScene& made, const fs::path& results) {
    const PreparedSummary summary = summarise(made.system);
    MadeReport report{.has_scene = !made.scene.files.empty()};
    report.lines = {format_translated("What it is: {}.", summary.is),
                    format_translated("What was added: {}.", summary.added),
                    format_translated("What to look at first: {}.", summary.look_first)};
    report.lines.push_back(
        report.has_scene ? format_translated("In your hand: {}.", made.scene.in_hand)
                         : std::string(translated(
                               "No scene could be made from this structure; see the details.")));
    report.details = format_translated("Written to {}", results.string()) + "\n\n" +
                     made.system.report.to_plain_text();
    return report;
}

struct WrittenScene {
    MadeScene made;
    fs::path folder;  // the new folder of its files
    HandOffer in_hand;
};

// Draws the picture that the start screen shows of the scene until it was open.
void keep_card_picture(WindowShell& shell, const WrittenScene& written) {
    const fs::path file = find_card_picture(written.folder / "scene.toml");
    if (file.empty() || !shell.graphics() || written.made.scene.files.empty()) return;
    WordedFrame frame{build_preview(written.made.system.structure, written.in_hand.atoms), {}};
    OrbitCamera camera;
    const float aspect = static_cast<float>(card_picture_width) / card_picture_height;
    frame_all(camera, frame.scene, {aspect, 1});
    frame.scene.camera = frame_camera(camera, frame.scene);
    std::optional<TextPainter> no_words;
    try {
        shell.graphics()->swapchain.wait();  // the renderer's last frame is done
        const Picture picture =
            draw_worded(shell.graphics()->renderer, {card_picture_width, card_picture_height, 4},
                        frame, no_words);
        make_folder(file.parent_path());
        write_png(file, picture, Existing::Replace);
    } catch (const GpuError&) {  // then the card has none
    } catch (const LoadError&) {
    }
}

// Asks what the person will hold if `asks`. Returns nothing where it was cancelled.
std::optional<WrittenScene> prepare_below(WindowShell& shell, SceneRequest request,
                                          const fs::path& folder, bool asks) {
    const std::optional<Structure> structure = read_and_show(shell, request.structure);
    if (!structure) return std::nullopt;
    std::optional<MadeScene> made = make_with_remedies(shell, *structure, request);
    if (!made) return std::nullopt;
    std::optional<HandOffer> in_hand = choose_hand_for(shell, *made, asks);
    if (!in_hand) return std::nullopt;
    request.grab = in_hand->grab;
    shell.show_behind(build_preview(made->system.structure, in_hand->atoms));
    WrittenScene written{std::move(*made), find_free_folder(folder, request.structure),
                         std::move(*in_hand)};
    request.title = written.folder.filename().string();
    const std::string title =
        format_translated("Preparing {}", request.structure.filename().string());
    const auto add = [&](const StageFunction& on_stage) {
        add_scene(request, on_stage, written.made);
    };
    if (!shell.work(title, add)) return std::nullopt;
    write_prepared(written.made.system, written.folder, written.made.title,
                   written.made.scene.files);
    keep_card_picture(shell, written);
    return written;
}

}  // namespace

std::vector<std::vector<fs::path>> split_structures(std::span<const fs::path> files) {
    std::vector<std::vector<fs::path>> groups;
    for (const fs::path& file : files)
        if (is_structure(file)) groups.push_back({file});
    if (groups.size() < 2) return {{files.begin(), files.end()}};
    const std::size_t structures = groups.size();
    for (const fs::path& file : files) {
        if (is_structure(file)) continue;
        const bool is_of_all = is_of_force_field(file) || is_of_ligand(file);
        bool is_of_one = false;
        for (std::size_t i = 0; i < structures; ++i) {
            const bool has_name = name_of_structure(groups[i][0]) == name_of_structure(file);
            if (!is_of_all && !(is_topology(file) && has_name)) continue;
            groups[i].push_back(file);
            is_of_one = true;
        }
        if (!is_of_one) groups.push_back({file});
    }
    return groups;
}

std::optional<fs::path> open_structure(WindowShell& shell, std::span<const fs::path> files,
                                       const fs::path& folder, const std::string& said) {
    const PictureOfPages picture(shell);
    const std::optional<WrittenScene> written =
        prepare_below(shell, build_request(files), folder, true);
    if (!written) return std::nullopt;
    MadeReport report = describe_made(written->made, written->folder);
    if (!said.empty()) report.lines.insert(report.lines.begin(), said);
    shell.show_behind(build_preview(written->made.system.structure, written->in_hand.atoms),
                      1 - page_share);
    const std::optional<bool> goes_on = show_report(shell, report);
    if (goes_on == false) {
        std::error_code error;
        fs::remove_all(written->folder, error);  // it was made just now
    }
    if (!goes_on.value_or(false)) return std::nullopt;
    return written->folder / "scene.toml";
}

PreparedEach prepare_each(WindowShell& shell, std::span<const std::vector<fs::path>> groups,
                          const fs::path& folder) {
    const PictureOfPages picture(shell);
    PreparedEach each;
    const auto note_problem = [&](std::string problem) {
        if (each.problem.empty()) each.problem = std::move(problem);
    };
    std::vector<std::string> made;
    for (const std::vector<fs::path>& group : groups) {
        try {
            const std::optional<WrittenScene> written =
                prepare_below(shell, build_request(group), folder, false);
            if (!written) {
                note_problem(
                    format_translated("{} was not prepared.", group[0].filename().string()));
                break;
            } else if (written->made.scene.files.empty()) {
                note_problem(format_translated("No scene could be made from {}; see {}.",
                                               group[0].filename().string(),
                                               (written->folder / "report.txt").string()));
            } else {
                made.push_back(written->folder.filename().string());
            }
        } catch (const LoadError& error) {
            note_problem(without_options(error.what()));
        }
    }
    if (!made.empty())
        each.said = format_translated("Prepared {} of {} structures, see Yours: {}.", made.size(),
                                      groups.size(), fmt::format("{}", fmt::join(made, ", ")));
    return each;
}

}  // namespace palpa
