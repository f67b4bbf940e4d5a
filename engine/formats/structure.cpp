#include "formats/structure.h"

#include "core/load_error.h"
#include "core/text.h"
#include "formats/crd.h"
#include "formats/gro.h"
#include "formats/gzip.h"
#include "formats/mmcif.h"
#include "formats/pdb.h"

#include <fmt/format.h>
#include <string>

namespace palpa {

Structure read_structure(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) {
        throw LoadError({path.string()}, "is a folder; expected a structure file in it");
    }
    std::string ending = upper_case(path.extension().string());
    if (ending == ".GZ") ending = upper_case(path.stem().extension().string());
    if (ending == ".PDB" || ending == ".ENT") return read_pdb(path);
    if (ending == ".CIF" || ending == ".MMCIF") return read_mmcif(path);
    if (ending == ".CRD" || ending == ".COR") {
        return parse_crd(read_packed_text_file(path), path.string());
    }
    if (ending == ".GRO") return parse_gro(read_packed_text_file(path), path.string());
    throw LoadError({path.string()},
                    fmt::format("'{}' is not the ending of a structure file; expected .pdb, .ent, "
                                ".cif, .mmcif, .crd, .cor or .gro, or one of these followed by .gz",
                                path.extension().string()));
}

}  // namespace palpa
