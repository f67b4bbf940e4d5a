// palpa-lab bench: speed against error of scenes, of kernels, and of reading files, on this
// machine.
#pragma once
#include "tools/lab/bench/adaptive.h"
#include "tools/lab/bench/answer.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace palpa {

struct BenchOptions {
    std::vector<std::filesystem::path> scenes;
    std::vector<std::filesystem::path> structures;  // to time the reading of, each
    std::vector<std::filesystem::path> toppar;      // and of these CHARMM files, together
    std::vector<std::string> settings;
    bool render = false;     // pictures, instead of loading and steps
    std::size_t atoms = 0;   // that scenes are repeated to for pictures; 0: as they are
    bool kernel = false;     // the kernels of pairs alone, likewise; needs no scene
    bool tree = false;       // passes over the assembly trees, likewise
    bool statics = false;    // ways to rest of flexible scenes, likewise
    bool window = false;     // how long until a person feels something, likewise
    bool servo = false;      // ticks of guarded coupling, likewise; needs no scene
    bool mouse = false;      // a person at the mouse draws a molecule out, likewise
    int runs = 5;            // with it: sessions
    double longest_s = 180;  // with it: longest session
    bool engine = false;     // frames of a remote engine, likewise; needs no scene
    bool adaptive = false;   // few active joints in flexible scenes, likewise
    bool spheres = false;    // with it: of spheres cut from the scenes' systems
    bool best = false;       // with it: what the best choice of joints could do
    bool table = false;      // with it: Markdown
    AdaptiveBenchSettings adaptive_settings;
    std::optional<int> poses;  // of either
    bool answer = false;       // error of the force at the hand against time, likewise
    AnswerBenchSettings answer_settings;
    std::optional<std::filesystem::path> plot;  // SVG of it
    bool overwrites = false;                    // earlier files of this command
    bool json = false;
};

// Throws LoadError on bad input. Returns the exit code.
int bench_command(const BenchOptions& options);

}  // namespace palpa
