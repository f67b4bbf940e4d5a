#include <cstddef>
// How different two colours look, to people with and without a deficiency of colour vision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palpa::test {

using Colour = std::array<double, 3>;  // linear RGB with the primaries of sRGB, 0 to 1
using Lab = std::array<double, 3>;     // CIE L*, a*, b*
using ColourMatrix = std::array<Colour, 3>;

inline Colour multiply(const ColourMatrix& matrix, const Colour& v) {
    Colour product{};
    for (std::size_t i = 0; i < 3; ++i) {
        product[i] = matrix[i][0] * v[0] + matrix[i][1] * v[1] + matrix[i][2] * v[2];
    }
    return product;
}

// Of the display's white, D65.
inline Lab lab_of(const Colour& linear) {
    // IEC 61966-2-1.
    constexpr ColourMatrix to_xyz{{{0.4124564, 0.3575761, 0.1804375},
                                   {0.2126729, 0.7151522, 0.0721750},
                                   {0.0193339, 0.1191920, 0.9503041}}};
    Colour inside = linear;
    for (double& channel : inside) channel = std::clamp(channel, 0.0, 1.0);
    const Colour xyz = multiply(to_xyz, inside), white = multiply(to_xyz, {1, 1, 1});
    Colour f{};
    for (std::size_t i = 0; i < 3; ++i) {
        constexpr double d = 6.0 / 29;
        const double t = xyz[i] / white[i];
        f[i] = t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

// CIEDE2000, in the form and with the equation numbers of G. Sharma, W. Wu, E. N. Dalal, Color Res.
// Appl. 30, 21 (2005).
inline double colour_difference(const Lab& one, const Lab& two) {
    constexpr double degree = std::numbers::pi / 180;
    const auto saturation = [](double chroma) {
        const double c7 = std::pow(chroma, 7);
        return std::sqrt(c7 / (c7 + std::pow(25.0, 7)));
    };
    const auto hue = [](double b, double a) {
        const double angle = a == 0 && b == 0 ? 0 : std::atan2(b, a) / degree;
        return angle < 0 ? angle + 360 : angle;
    };
    const double mean_c = (std::hypot(one[1], one[2]) + std::hypot(two[1], two[2])) / 2;
    const double stretch = 1.5 - 0.5 * saturation(mean_c);  // 4, 5
    const double a1 = stretch * one[1], a2 = stretch * two[1];
    const double c1 = std::hypot(a1, one[2]), c2 = std::hypot(a2, two[2]);  // 6
    const double h1 = hue(one[2], a1), h2 = hue(two[2], a2);                // 7
    const bool has_grey = c1 * c2 == 0;
    double dh = h2 - h1;  // 10
    if (dh > 180) dh -= 360;
    if (dh < -180) dh += 360;
    if (has_grey) dh = 0;
    const double dl = two[0] - one[0], dc = c2 - c1;                          // 8, 9
    const double d_hue = 2 * std::sqrt(c1 * c2) * std::sin(dh * degree / 2);  // 11
    const double l = (one[0] + two[0]) / 2, c = (c1 + c2) / 2;                // 12, 13
    double h = h1 + h2;                                                       // 14
    if (!has_grey) {
        if (std::abs(h1 - h2) > 180) h += h < 360 ? 360 : -360;
        h /= 2;
    }
    const double t = 1 - 0.17 * std::cos((h - 30) * degree) + 0.24 * std::cos(2 * h * degree) +
                     0.32 * std::cos((3 * h + 6) * degree) -
                     0.20 * std::cos((4 * h - 63) * degree);          // 15
    const double turn = 30 * std::exp(-std::pow((h - 275) / 25, 2));  // 16
    const double from_50 = (l - 50) * (l - 50);
    const double sl = 1 + 0.015 * from_50 / std::sqrt(20 + from_50);           // 18
    const double sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;                   // 19, 20
    const double rotation = -std::sin(2 * turn * degree) * 2 * saturation(c);  // 17, 21
    const double x = dl / sl, y = dc / sc, z = d_hue / sh;
    return std::sqrt(x * x + y * y + z * z + rotation * y * z);  // 22
}

// What people without one kind of cone see, to the eyes of those who have all three: G. M. Machado,
// M. M. Oliveira, L. A. F. Fernandes, IEEE Trans. Vis. Comput. Graph. 15, 1291 (2009), severity 1.
struct Vision {
    const char* name;
    ColourMatrix matrix;  // of linear RGB
};
inline constexpr std::array<Vision, 4> visions{{
    {"normal", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"protan",
     {{{0.152286, 1.052583, -0.204868},
       {0.114503, 0.786281, 0.099216},
       {-0.003882, -0.048116, 1.051998}}}},
    {"deutan",
     {{{0.367322, 0.860646, -0.227968},
       {0.280085, 0.672501, 0.047413},
       {-0.011820, 0.042940, 0.968881}}}},
    {"tritan",
     {{{1.255528, -0.076749, -0.178779},
       {-0.078411, 0.930809, 0.147602},
       {0.004733, 0.691367, 0.303900}}}},
}};

inline double colour_difference(const Vision& vision, const Colour& one, const Colour& two) {
    return colour_difference(lab_of(multiply(vision.matrix, one)),
                             lab_of(multiply(vision.matrix, two)));
}

}  // namespace palpa::test
