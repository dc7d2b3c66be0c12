#pragma once
// Images of a few pixels.
#include <string>
#include <string_view>

namespace lightwalk::test {

/// The bytes that hexadecimal digits stand for.
inline std::string bytes_of_digits(std::string_view digits) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
    return bytes;
}

/// PNG of 2 x 2 pixels of 8 bits: red and green above, blue and grey (188) below; the grey one is
/// transparent.
inline std::string small_png() {
    return bytes_of_digits(
        "89504e470d0a1a0a0000000d494844520000000200000002080600000072b60d240000001649444154789c63"
        "f8cfc0f01f0c81f4ff3d7bf6300000466e082f305cabe70000000049454e44ae426082");
}

/// PNG of 4 x 2 pixels of 8 bits, all of them 128 64 32.
inline std::string wide_png() {
    return bytes_of_digits(
        "89504e470d0a1a0a0000000d4948445200000004000000020802000000f0caea340000001049444154789c63"
        "687050802306640e005e1a0701cd2c70350000000049454e44ae426082");
}

/// TIFF of 2 x 1 pixels of 16 bits: 65535 0 32768, and 0 65535 1000.
inline std::string small_tiff() {
    return bytes_of_digits(
        "49492a001a000000ffff000000800000ffffe803100010001000090000010300010000000200000001010300"
        "0100000001000000020103000300000014000000030103000100000001000000060103000100000002000000"
        "1101040001000000080000001501030001000000030000001601030001000000010000001701040001000000"
        "0c00000000000000");
}

/// TGA of 2 x 1 pixels of 32 bits: 255 0 128, and 0 255 64, which is transparent.
inline std::string small_tga() {
    return bytes_of_digits("0000020000000000000000000200010020088000ffff40ff0000");
}

/// BMP of the same colours, of 24 bits.
inline std::string small_bmp() {
    return bytes_of_digits(
        "424d3e000000000000003600000028000000020000000100000001001800000000000800000013"
        "0b0000130b000000000000000000008000ff40ff000000");
}

/// WebP of 8 x 4 pixels, without loss: all 250 100 20, half transparent (128).
inline std::string small_webp() {
    return bytes_of_digits(
        "524946461e000000574542505650384c110000002f07c000100750b2ea97a2808188e87f0000");
}

/// The same with loss, its alpha in a chunk of its own.
inline std::string lossy_webp() {
    return bytes_of_digits(
        "524946466400000057454250565038580a00000010000000070000030000414c50480a000000010750c0880844"
        "44"
        "ff0356503820340000003002009d012a0800040000c01225a00274ba01f801fa0004680000fed8eefff44ce473"
        "bd"
        "dff44d7ffdbe102a5a4cffb764000000");
}

}  // namespace lightwalk::test
