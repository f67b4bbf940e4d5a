// Largest stable K of the paper's loop, a reference computed by another program: position sampled,
// force -K x one period later and held; handle of 45 g, viscosity of the device, hand.
#pragma once
#include "haptics/hand.h"

#include <array>
#include <cstdint>

namespace palpa::test {

struct CriticalStiffness {
    double viscosity;  // Ns/m
    HandGrip grip;
    std::uint64_t period_ms;
    double K;  // N/m
};

inline const std::array critical_stiffness = std::to_array<CriticalStiffness>({
    {0.1, HandGrip::None, 1, 66.7},   {0.1, HandGrip::None, 5, 13.4},
    {0.1, HandGrip::None, 14, 4.80},  {0.1, HandGrip::None, 33, 2.06},
    {0.1, HandGrip::None, 83, 0.842}, {0.5, HandGrip::None, 1, 334},
    {0.5, HandGrip::None, 5, 67.7},   {0.5, HandGrip::None, 14, 24.8},
    {0.5, HandGrip::None, 33, 11.0},  {0.5, HandGrip::None, 83, 4.80},
    {2.0, HandGrip::None, 1, 1350},   {2.0, HandGrip::None, 5, 282},
    {2.0, HandGrip::None, 14, 109},   {2.0, HandGrip::None, 33, 51.2},
    {2.0, HandGrip::None, 83, 22.7},  {0.1, HandGrip::Light, 1, 735},
    {0.1, HandGrip::Light, 5, 149},   {0.1, HandGrip::Light, 14, 55.4},
    {0.1, HandGrip::Light, 33, 27.3}, {0.1, HandGrip::Light, 83, 22.4},
    {0.1, HandGrip::Slack, 1, 734},   {0.1, HandGrip::Slack, 5, 147},
    {0.1, HandGrip::Slack, 14, 53.2}, {0.1, HandGrip::Slack, 33, 23.6},
    {0.1, HandGrip::Slack, 83, 11.9}, {0.1, HandGrip::Medium, 1, 2750},
    {0.1, HandGrip::Medium, 5, 568},  {0.1, HandGrip::Medium, 14, 226},
    {0.1, HandGrip::Medium, 33, 137}, {0.1, HandGrip::Medium, 83, 148},
    {0.1, HandGrip::Firm, 1, 6792},   {0.1, HandGrip::Firm, 5, 1419},
    {0.1, HandGrip::Firm, 14, 586},   {0.1, HandGrip::Firm, 33, 385},
    {0.1, HandGrip::Firm, 83, 394},
});

}  // namespace palpa::test
