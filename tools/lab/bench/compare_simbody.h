// The interface between the two halves of tools/lab/scripts/compare_simbody: Simbody's headers are
// C++17, ours C++20.
//
// Å, amu and kcal/mol for both: the unit of time is AKMA's.
#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace palpa {

struct PeerBody {
    int parent = -1;                    // none for a base
    std::array<std::size_t, 2> axis{};  // of the joint, as Body::axis
    std::vector<std::size_t> atoms;
};

struct PeerTree {
    std::vector<double> masses;
    std::vector<std::array<double, 3>> positions, forces;
    std::vector<PeerBody> bodies;
};

class Peer {
public:
    Peer() = default;
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;
    virtual ~Peer() = default;

    // From positions and wrenches on bodies, keeping nothing that is known.
    virtual void update_accelerations() = 0;
    virtual double joint_acceleration(std::size_t body) const = 0;
};

std::unique_ptr<Peer> build_simbody(const PeerTree& tree);

}  // namespace palpa
