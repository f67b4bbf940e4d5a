#include "tools/lab/bench/engine.h"

#include "imd/client.h"
#include "imd/server.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpa {
namespace {

constexpr std::size_t frames = 300, warm_up = 20;

// Client and server in one thread, in turns; times are made up and never late.
class Pair {
public:
    explicit Pair(std::size_t atoms)
        : server_({.port = 0, .atoms = atoms}),
          client_({.port = server_.port(), .limits = {.atoms = atoms}}) {
        if (!server_.problem().empty()) throw std::runtime_error(server_.problem());
        client_.connect(0);
        for (int i = 0; i < 1000 && server_.clients() == 0; ++i) take_turns();
        if (server_.clients() == 0) throw std::runtime_error("no connection over the loopback");
    }

    // Seconds that the client takes for one frame.
    double time_frame(const ImdFrame& frame, std::vector<Vec3>& table) {
        (void)server_.count_step();
        server_.send(frame);
        const std::uint64_t before = client_.frames();
        double seconds = 0;
        while (client_.frames() == before) {
            server_.poll(0, 0);
            seconds += seconds_of([&] { client_.poll(0, 0); });
        }
        return seconds +
               seconds_of([&] { std::ranges::copy(client_.frame()->coordinates, table.begin()); });
    }

    double time_pull(const std::vector<std::int32_t>& atoms, const std::vector<Vec3>& forces) {
        return seconds_of([&] {
            (void)client_.pull(atoms, forces);
            client_.poll(0, 0);
        });
    }

    void take_turns() {
        server_.poll(0, 1);
        client_.poll(0, 1);
    }

private:
    ImdServer server_;
    ImdClient client_;
};

ImdFrame make_up_frame(std::size_t atoms) {
    ImdFrame frame;
    frame.energies.emplace();
    for (std::size_t i = 0; i < atoms; ++i) {
        const auto x = static_cast<double>(i);
        frame.coordinates.emplace_back(0.01 * x, 0.02 * x, -0.01 * x);
    }
    return frame;
}

}  // namespace

void bench_engine(std::vector<BenchRow>& rows) {
    for (const std::size_t atoms : {std::size_t{3275}, std::size_t{120'400}}) {
        Pair pair(atoms);
        const ImdFrame frame = make_up_frame(atoms);
        std::vector<Vec3> table(atoms);
        BenchRow row{fmt::format("engine/frame/{}", atoms), {}, "us"};
        for (std::size_t i = 0; i < frames + warm_up; ++i) {
            const double seconds = pair.time_frame(frame, table);
            if (i >= warm_up) row.samples.push_back(1e6 * seconds);
        }
        rows.push_back(std::move(row));
        constexpr std::size_t pulled = 130;  // as many as TL-3 has
        std::vector<std::int32_t> numbers(pulled);
        std::iota(numbers.begin(), numbers.end(), 0);
        const std::vector<Vec3> forces(pulled, Vec3(1, 0, 0));
        BenchRow pulls{fmt::format("engine/pull/{}", pulled), {}, "us"};
        for (std::size_t i = 0; i < frames; ++i) {
            pulls.samples.push_back(1e6 * pair.time_pull(numbers, forces));
            pair.take_turns();
        }
        if (atoms == 3275) rows.push_back(std::move(pulls));
    }
}

}  // namespace palpa
