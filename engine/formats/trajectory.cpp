#include "formats/trajectory.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/dcd.h"
#include "formats/lines.h"
#include "formats/mmcif_models.h"
#include "formats/pdb_models.h"
#include "formats/trr.h"
#include "formats/xtc.h"

#include <fmt/format.h>

namespace palpa {

std::unique_ptr<Trajectory> open_trajectory(const std::filesystem::path& path) {
    const std::string ending = upper_case(path.extension().string());
    if (ending == ".DCD") return open_dcd(ByteSource(path));
    if (ending == ".XTC") return open_xtc(ByteSource(path));
    if (ending == ".TRR") return open_trr(ByteSource(path));
    if (ending == ".PDB" || ending == ".ENT") return open_pdb_models(ByteSource(path));
    if (ending == ".CIF" || ending == ".MMCIF") return open_mmcif_models(ByteSource(path));
    throw LoadError({path.string()},
                    fmt::format("'{}' is not the ending of a trajectory file; expected .dcd, .xtc, "
                                ".trr, .pdb, .ent, .cif or .mmcif",
                                path.extension().string()));
}

void fail_frame(const std::string& file, std::size_t frame, const std::string& what) {
    throw LoadError({file}, fmt::format("frame {}: {}", frame + 1, what));
}

void check_frame(const std::string& file, std::size_t frame, std::size_t count) {
    if (frame < count) return;
    throw LoadError({file}, fmt::format("has no frame {}; expected one of its {} frame{}",
                                        frame + 1, count, count == 1 ? "" : "s"));
}

void check_positions(const std::string& file, std::size_t frame, std::span<const Vec3> positions) {
    for (std::size_t atom = 0; atom < positions.size(); ++atom) {
        for (const double value : positions[atom]) {
            // Written so that what is not a number fails.
            if (value >= -farthest_coordinate && value <= farthest_coordinate) continue;
            fail_frame(file, frame,
                       fmt::format("atom {} has the coordinate {}; expected a number within ±{} Å",
                                   atom + 1, value, farthest_coordinate));
        }
    }
}

std::string cut_off_note(std::size_t frame) {
    return fmt::format("ends within frame {}: the file may have been cut off", frame + 1);
}

}  // namespace palpa
