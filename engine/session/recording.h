// A session on disk: a folder with trace.csv, summary.json, session.toml and the scene's inputs.
#pragma once
#include "core/files.h"
#include "haptics/servo.h"
#include "scene/description.h"
#include "session/statistics.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace palpa {

// A hash of the scene, every field and the content of every file that it names. 16 hex digits.
std::string scene_hash(const SceneDescription& scene);

// The trace's first line, without its end. One column a value, the unit last in the name.
std::string trace_header();

// One of its rows, with its end: every number in the shortest form that reads back to the same
// bits.
std::string trace_row(const ServoTick& tick);

// The summary as a JSON object; scripts rely on its keys, which the README of tools lists.
std::string format_summary(const SceneDescription& scene, const Summary& summary);

// Throws LoadError where a Recording in the folder would, before anything long is done for it.
void check_record_folder(const std::filesystem::path& folder, bool overwrites);

class Recording {
public:
    // Makes the folder and writes session.toml and the inputs: what is needed to run the session
    // again is there from the first moment. Throws LoadError if the folder cannot be written, if
    // another run records into it, or if it is not empty. A recording in it is replaced if
    // `overwrites`: the files that belong to one, and nothing else.
    Recording(const std::filesystem::path& folder, const SceneDescription& scene,
              bool overwrites = false);

    // Every `every`th tick becomes a row. What was written stays readable if the run is cut off.
    void add(const ServoTick& tick);

    // Writes what is left of the trace, and the summary.
    void finish(const Summary& summary);

private:
    void flush();

    std::filesystem::path folder_;
    SceneDescription scene_;
    std::optional<FolderLock> lock_;
    std::optional<NewFile> trace_;
    std::string rows_;
    std::uint64_t tick_ = 0;
};

}  // namespace palpa
