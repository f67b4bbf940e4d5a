#include "formats/structure.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/crd.h"
#include "formats/gro.h"
#include "formats/mmcif.h"
#include "formats/pdb.h"

#include <fmt/format.h>
#include <string>

namespace palpa {

Structure read_structure(const std::filesystem::path& path) {
    const std::string ending = upper_case(path.extension().string());
    if (ending == ".PDB" || ending == ".ENT") return read_pdb(path);
    if (ending == ".CIF" || ending == ".MMCIF") return read_mmcif(path);
    if (ending == ".CRD" || ending == ".COR") return read_crd(path);
    if (ending == ".GRO") return read_gro(path);
    const char* const hint = ending == ".GZ" ? " (unpack it first)" : "";
    throw LoadError({path.string()},
                    fmt::format("'{}' is no ending of a structure file{}; expected .pdb, .ent, "
                                ".cif, .mmcif, .crd, .cor or .gro",
                                path.extension().string(), hint));
}

}  // namespace palpa
