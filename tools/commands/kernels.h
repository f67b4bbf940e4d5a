// The kernels that compute: the best for this processor, unless the environment variable
// PALPA_KERNELS or a recording names others (field/processor.h).
#pragma once
#include <filesystem>
#include <string>

namespace palpa {

// Makes PALPA_KERNELS count, and sums of large matrices the same on every processor. Throws
// LoadError where this processor has no such kernels.
void choose_kernels();

// Computes with the kernels of a recording while it lives, and with those from before afterwards.
// PALPA_KERNELS counts more; a note says where the processor lacks those of the recording. Not
// while another thread calls a kernel.
class RecordedKernels {
public:
    explicit RecordedKernels(const std::filesystem::path& folder);
    ~RecordedKernels();
    RecordedKernels(const RecordedKernels&) = delete;
    RecordedKernels& operator=(const RecordedKernels&) = delete;

private:
    std::string before_;
};

}  // namespace palpa
