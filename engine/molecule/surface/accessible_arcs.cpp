#include "molecule/surface/accessible_arcs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpa {
namespace {

constexpr double whole_turn = 4;  // square angles

// With the directions of both ends, x and y.
struct Range {
    double from = 0, to = 0;
    std::array<double, 2> first{}, last{};
};

// The circle in which two spheres meet; radius 0 where they do not, or hardly.
AccessibleArc circle_between(const AtomBall& a, const AtomBall& b) {
    AccessibleArc circle;
    const Vec3 between = b.centre - a.centre;
    const double distance = between.norm();
    if (distance >= a.radius + b.radius || distance <= std::abs(a.radius - b.radius)) return circle;
    const double along =
        (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2 * distance);
    circle.axis = between / distance;
    circle.centre = a.centre + along * circle.axis;
    circle.radius = std::sqrt(std::max(a.radius * a.radius - along * along, 0.0));
    circle.x = circle.axis.unitOrthogonal();
    circle.y = circle.axis.cross(circle.x);
    return circle;
}

// The circle's points at angle t are inside of a ball where a cos t + b sin t > s.
struct Cover {
    double a = 0, b = 0, s = 0;

    bool is_nothing() const { return s >= 0 && s * s >= a * a + b * b; }
    bool is_everything() const { return s < 0 && s * s >= a * a + b * b; }
};

Cover cover_by(const AtomBall& ball, const AccessibleArc& circle) {
    const Vec3 to_ball = ball.centre - circle.centre;
    const double r = circle.radius;
    // A ball that only touches the circle, as a second one at the same place does, buries nothing.
    constexpr double margin = 1e-9;  // Å
    return {to_ball.dot(circle.x), to_ball.dot(circle.y),
            (r * r + to_ball.squaredNorm() - ball.radius * ball.radius) / (2 * r) + margin};
}

// What a ball covers, beginning in the first turn. To rounding that may be nothing, and then from
// equals to, or all, and then they are a turn apart.
Range range_of(const Cover& cover) {
    // Both ends of the chord a x + b y = s of the unit circle.
    const double square = cover.a * cover.a + cover.b * cover.b;
    const double along = cover.s / square, across = std::sqrt(square - cover.s * cover.s) / square;
    Range range;
    range.first = {along * cover.a + across * cover.b, along * cover.b - across * cover.a};
    range.last = {along * cover.a - across * cover.b, along * cover.b + across * cover.a};
    range.from = square_angle(range.first[0], range.first[1]);
    range.to = square_angle(range.last[0], range.last[1]);
    if (range.to < range.from) range.to += whole_turn;
    // Less than half a circle, or more, as the chord's side says.
    const bool is_less = range.to - range.from < whole_turn / 2;
    if (is_less && cover.s < 0) range.to = range.from + whole_turn;
    if (!is_less && cover.s >= 0) range.to = range.from;
    return range;
}

// What is free on a circle while one ball after the other covers a part of it.
class FreeRanges {
public:
    void clear() {
        is_whole_ = true;
        ranges_.clear();
    }
    bool empty() const { return !is_whole_ && ranges_.empty(); }

    void remove(const Range& covered) {
        if (covered.from == covered.to) return;
        if (is_whole_) {
            is_whole_ = false;
            if (covered.from + whole_turn > covered.to)
                ranges_.push_back(
                    {covered.to, covered.from + whole_turn, covered.last, covered.first});
            return;
        }
        left_.clear();
        for (Range range : ranges_) {
            for (const double shift : {-whole_turn, 0.0, whole_turn}) {
                const double from = covered.from + shift, to = covered.to + shift;
                if (to <= range.from || from >= range.to) continue;
                if (from > range.from)
                    left_.push_back({range.from, from, range.first, covered.first});
                range.from = to;
                range.first = covered.last;
            }
            if (range.from < range.to) left_.push_back(range);
        }
        std::swap(ranges_, left_);
    }

    void add_arcs(AccessibleArc circle, std::vector<AccessibleArc>& arcs) const {
        const auto add = [&](const Range& range) {
            circle.from = range.from;
            circle.to = range.to;
            circle.ends = {point_at(circle, range.first), point_at(circle, range.last)};
            arcs.push_back(circle);
        };
        if (is_whole_) add({0, whole_turn, {1, 0}, {1, 0}});
        for (const Range& range : ranges_) add(range);
    }

private:
    static Vec3 point_at(const AccessibleArc& circle, const std::array<double, 2>& direction) {
        return circle.centre + circle.radius * (direction[0] * circle.x + direction[1] * circle.y);
    }

    bool is_whole_ = true;
    std::vector<Range> ranges_, left_;
};

}  // namespace

void find_accessible_arcs(const AtomBall& ball, std::span<const AtomBall> balls,
                          std::vector<AccessibleArc>& arcs) {
    std::vector<AtomBall> near;
    for (const AtomBall& other : balls) {
        const double sum = ball.radius + other.radius;
        if (other.atom != ball.atom && (other.centre - ball.centre).squaredNorm() < sum * sum)
            near.push_back(other);
    }
    // The nearest bury most.
    std::ranges::sort(near, {}, [&](const AtomBall& other) {
        return (other.centre - ball.centre).norm() - other.radius;
    });
    FreeRanges free;
    for (const AtomBall& other : near) {
        if (other.atom < ball.atom) continue;
        const AccessibleArc circle = circle_between(ball, other);
        if (circle.radius == 0) continue;
        free.clear();
        for (const AtomBall& third : near) {
            if (third.atom == other.atom) continue;
            const Cover cover = cover_by(third, circle);
            if (cover.is_nothing()) continue;
            free.remove(cover.is_everything() ? Range{0, whole_turn, {}, {}} : range_of(cover));
            if (free.empty()) break;
        }
        free.add_arcs(circle, arcs);
    }
}

void find_nearest_on_arc(const AccessibleArc& arc, const Vec3& place, double& distance,
                         Vec3& nearest) noexcept {
    const Vec3 offset = place - arc.centre;
    const double height = offset.dot(arc.axis);
    if (std::abs(height) >= distance) return;
    const double out = std::sqrt(std::max(offset.squaredNorm() - height * height, 0.0));
    const double gap = out - arc.radius;
    if (height * height + gap * gap >= distance * distance) return;
    const double x = offset.dot(arc.x), y = offset.dot(arc.y);
    double angle = out > 0 ? square_angle(x, y) : arc.from;
    while (angle < arc.from) angle += whole_turn;
    if (angle <= arc.to) {
        distance = std::sqrt(height * height + gap * gap);
        nearest =
            out > 0 ? Vec3(arc.centre + arc.radius / out * (x * arc.x + y * arc.y)) : arc.ends[0];
        return;
    }
    for (const Vec3& end : arc.ends) {
        const double to_end = (place - end).norm();
        if (to_end >= distance) continue;
        distance = to_end;
        nearest = end;
    }
}

}  // namespace palpa
