// Largest stable K of the paper's loop, a reference computed by another program: position sampled,
// force -K x one period later and held; handle of 45 g, viscosity of the device, hand.
#pragma once
#include "haptics/hand.h"

#include <array>
#include <cstdint>

namespace palpa::test {

struct CriticalStiffness {
    double viscosity;  // Ns/m
    Grip grip;
    std::uint64_t period_ms;
    double K;  // N/m
};

inline const std::array critical_stiffness = std::to_array<CriticalStiffness>({
    {0.1, Grip::None, 1, 66.7},   {0.1, Grip::None, 5, 13.4},   {0.1, Grip::None, 14, 4.80},
    {0.1, Grip::None, 33, 2.06},  {0.1, Grip::None, 83, 0.842}, {0.5, Grip::None, 1, 334},
    {0.5, Grip::None, 5, 67.7},   {0.5, Grip::None, 14, 24.8},  {0.5, Grip::None, 33, 11.0},
    {0.5, Grip::None, 83, 4.80},  {2.0, Grip::None, 1, 1350},   {2.0, Grip::None, 5, 282},
    {2.0, Grip::None, 14, 109},   {2.0, Grip::None, 33, 51.2},  {2.0, Grip::None, 83, 22.7},
    {0.1, Grip::Light, 1, 735},   {0.1, Grip::Light, 5, 149},   {0.1, Grip::Light, 14, 55.4},
    {0.1, Grip::Light, 33, 27.3}, {0.1, Grip::Light, 83, 22.4}, {0.1, Grip::Slack, 1, 734},
    {0.1, Grip::Slack, 5, 147},   {0.1, Grip::Slack, 14, 53.2}, {0.1, Grip::Slack, 33, 23.6},
    {0.1, Grip::Slack, 83, 11.9}, {0.1, Grip::Medium, 1, 2750}, {0.1, Grip::Medium, 5, 568},
    {0.1, Grip::Medium, 14, 226}, {0.1, Grip::Medium, 33, 137}, {0.1, Grip::Medium, 83, 148},
    {0.1, Grip::Firm, 1, 6792},   {0.1, Grip::Firm, 5, 1419},   {0.1, Grip::Firm, 14, 586},
    {0.1, Grip::Firm, 33, 385},   {0.1, Grip::Firm, 83, 394},
});

}  // namespace palpa::test
