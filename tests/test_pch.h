// Headers that every test wants, compiled once.
#pragma once
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <string>
#include <vector>
