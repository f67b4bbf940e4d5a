// Headers that every test wants, compiled once.
#pragma once
#include <fmt/format.h>
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <string>
#include <vector>
