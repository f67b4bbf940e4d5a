#include "render/picture.h"

#include "core/files.h"
#include "core/load_error.h"

#include <png.h>
#include <string>

namespace palpa {

void write_png(const std::filesystem::path& path, const Picture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGBA;
    image.flags = PNG_IMAGE_FLAG_FAST;
    png_alloc_size_t bytes = 0;
    std::string content;
    const bool sized =
        png_image_write_to_memory(&image, nullptr, &bytes, 0, picture.rgba.data(), 0, nullptr) != 0;
    content.resize(bytes);
    if (!sized || png_image_write_to_memory(&image, content.data(), &bytes, 0, picture.rgba.data(),
                                            0, nullptr) == 0) {
        throw LoadError({path.string()}, std::string("cannot be made: ") + image.message);
    }
    write_text_file(path, content);
}

}  // namespace palpa
