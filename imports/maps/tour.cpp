#include "imports/maps/tour.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "imports/maps/entity_keys.h"
#include "scenes/camera_path.h"

namespace regather::imports {

using scenes::Scene;

namespace {

constexpr float eye_height = 50, body = 12, camera_body = 3;  // A player is 56 units tall and 30 wide.
constexpr std::size_t most_stops = 200, most_neighbours = 12;
constexpr float longest_step = 1500, units_a_frame = 8, look_ahead = 128;
constexpr std::uint32_t fewest_frames = 31;

Vec3 heading(float degrees) {
    const float angle = degrees * (3.14159265f / 180);
    return {std::cos(angle), std::sin(angle), 0};
}

struct Step {
    std::size_t to;
    float length;
};
using Ways = std::vector<std::vector<Step>>;

Ways ways_between(std::span<const Stop> stops, const FreeSpace& space) {
    Ways ways(stops.size());
    std::vector<std::size_t> near(stops.size());
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const auto distance = [&](std::size_t j) { return length(stops[j].eye - stops[i].eye); };
        std::iota(near.begin(), near.end(), std::size_t{0});
        std::stable_sort(near.begin(), near.end(), [&](auto a, auto b) { return distance(a) < distance(b); });
        std::size_t tried = 0;
        for (const std::size_t j : near) {
            if (j == i || distance(j) <= 1) continue;
            if (tried == most_neighbours || distance(j) > longest_step) break;
            ++tried;
            const auto known = [&](const Step& step) { return step.to == j; };
            if (std::any_of(ways[i].begin(), ways[i].end(), known)) continue;
            if (!space.clear(stops[i].eye, stops[j].eye, body)) continue;
            ways[i].push_back({j, distance(j)});
            ways[j].push_back({i, distance(j)});
        }
    }
    return ways;
}

struct Reach {
    std::vector<float> distance;  // Infinite: no way there.
    std::vector<std::size_t> previous;
};

// E. W. Dijkstra 1959, for at most some hundred stops.
Reach reach_from(std::size_t start, const Ways& ways) {
    Reach reach{std::vector(ways.size(), std::numeric_limits<float>::infinity()),
                std::vector<std::size_t>(ways.size(), start)};
    std::vector<bool> done(ways.size(), false);
    reach.distance[start] = 0;
    for (;;) {
        std::size_t nearest = ways.size();
        for (std::size_t i = 0; i < ways.size(); ++i)
            if (!done[i] && std::isfinite(reach.distance[i]) &&
                (nearest == ways.size() || reach.distance[i] < reach.distance[nearest]))
                nearest = i;
        if (nearest == ways.size()) return reach;
        done[nearest] = true;
        for (const Step& step : ways[nearest])
            if (reach.distance[nearest] + step.length < reach.distance[step.to]) {
                reach.distance[step.to] = reach.distance[nearest] + step.length;
                reach.previous[step.to] = nearest;
            }
    }
}

std::size_t reached(const Reach& reach) {
    return static_cast<std::size_t>(std::count_if(reach.distance.begin(), reach.distance.end(),
                                                  [](float d) { return std::isfinite(d); }));
}

// Stops in the order of the walk.
std::vector<std::size_t> walk(std::span<const Stop> stops, const Ways& ways, std::size_t start,
                              double most_length) {
    std::vector<std::size_t> way{start};
    std::vector<bool> visited(stops.size(), false);
    visited[start] = true;
    for (double total = 0; total < most_length;) {
        const Reach reach = reach_from(way.back(), ways);
        std::size_t next = stops.size();
        for (const bool spawns : {true, false})
            for (std::size_t i = 0; i < stops.size() && (spawns || next == stops.size()); ++i)
                if (stops[i].is_spawn == spawns && !visited[i] && std::isfinite(reach.distance[i]) &&
                    (next == stops.size() || reach.distance[i] < reach.distance[next]))
                    next = i;
        if (next == stops.size()) break;
        std::vector<std::size_t> leg;
        for (std::size_t at = next; at != way.back(); at = reach.previous[at]) leg.push_back(at);
        for (auto at = leg.rbegin(); at != leg.rend(); ++at) visited[*at] = true;
        total += double{reach.distance[next]};
        way.insert(way.end(), leg.rbegin(), leg.rend());
    }
    return way;
}

// A line of straight pieces, measured by its length from the beginning.
class Line {
public:
    void append(Vec3 point) {
        if (!points_.empty() && trace::length(point - points_.back()) < 1) return;
        along_.push_back(points_.empty() ? 0 : along_.back() + trace::length(point - points_.back()));
        points_.push_back(point);
    }
    float length() const { return along_.back(); }
    const std::vector<float>& corners() const { return along_; }

    Vec3 direction(float at) const {
        const std::size_t i = piece(at);
        return normalize(points_[i + 1] - points_[i]);
    }
    Vec3 point(float at) const {  ///< Straight on after the end.
        const std::size_t i = piece(at);
        return points_[i] + direction(at) * (at - along_[i]);
    }

private:
    std::size_t piece(float at) const {
        const auto after = std::upper_bound(along_.begin() + 1, along_.end() - 1, at);
        return static_cast<std::size_t>(after - along_.begin()) - 1;
    }
    std::vector<Vec3> points_;
    std::vector<float> along_;
};

KeyFrame key_at(const Line& line, float at, std::uint32_t frame, bool straight) {
    KeyFrame key;
    key.frame = frame;
    key.position = line.point(at);
    key.target = (line.point(at + 0.5f * look_ahead) + line.point(at + look_ahead) +
                  line.point(at + 1.5f * look_ahead)) *
                 (1.0f / 3);
    if (straight || length(key.target - key.position) < 0.25f * look_ahead)
        key.target = key.position + line.direction(at) * look_ahead;
    return key;
}

// Keys at the corners and `spacing` apart between them.
std::vector<KeyFrame> keys_along(const Line& line, std::uint32_t frames, float spacing) {
    const float frame_length = line.length() / static_cast<float>(frames - 1);
    const auto frame_of = [&](float at) {
        return std::min(static_cast<std::uint32_t>(std::lround(at / frame_length)), frames - 1);
    };
    std::vector<std::uint32_t> at_frames{0};
    for (std::size_t i = 1; i < line.corners().size(); ++i) {
        const float from = line.corners()[i - 1], to = line.corners()[i];
        const auto pieces = static_cast<int>(std::ceil((to - from) / spacing));
        for (int piece = 1; piece <= pieces; ++piece) {
            const std::uint32_t frame =
                frame_of(from + (to - from) * (static_cast<float>(piece) / static_cast<float>(pieces)));
            if (frame > at_frames.back()) at_frames.push_back(frame);
        }
    }
    if (at_frames.back() != frames - 1) at_frames.push_back(frames - 1);
    std::vector<KeyFrame> keys;
    for (const std::uint32_t frame : at_frames)
        keys.push_back(key_at(line, static_cast<float>(frame) * frame_length, frame, false));
    return keys;
}

std::vector<KeyFrame> key_every_frame(const Line& line, std::uint32_t frames) {
    std::vector<KeyFrame> keys;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
        keys.push_back(key_at(
            line, line.length() * static_cast<float>(frame) / static_cast<float>(frames - 1), frame, true));
    return keys;
}

// The curve through the keys cuts corners and swings out: is it clear all the same?
bool is_clear(const std::vector<KeyFrame>& keys, std::uint32_t frames, const FreeSpace& space) {
    Scene scene;
    scene.camera_path = keys;
    scene.frames = frames;
    Vec3 before = keys.front().position;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const Camera camera = scenes::camera_at(scene, frame);
        if (length(camera.target - camera.position) < 0.1f * look_ahead) return false;
        if (!space.clear(before, camera.position, camera_body)) return false;
        before = camera.position;
    }
    return true;
}

// Looking where a spawn point looks: 90 degrees wide, 60 high.
std::size_t kinds_seen(const Stop& stop, const FreeSpace& space,
                       std::span<const std::uint32_t> kind_of_triangle) {
    constexpr int columns = 10, rows = 6;
    const Vec3 ahead = heading(stop.heading_degrees), left = heading(stop.heading_degrees + 90);
    std::set<std::uint32_t> kinds;
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            const float x = 2 * (static_cast<float>(column) + 0.5f) / columns - 1;
            const float y = 2 * (static_cast<float>(row) + 0.5f) / rows - 1;
            const Vec3 direction = ahead + left * x + Vec3{0, 0, 0.577f * y};
            if (const auto met = space.first_met(stop.eye, stop.eye + direction * 8192))
                kinds.insert(kind_of_triangle[*met]);
        }
    }
    return kinds.size();
}

// Where no way leads: forth as far as it goes, else a turn on the spot.
void stay(Tour& tour, const Stop& stop, const FreeSpace& space) {
    tour.frames = fewest_frames;
    const Vec3 ahead = heading(stop.heading_degrees);
    for (float distance = 8 * 32; distance >= 32; distance -= 32) {
        if (!space.clear(stop.eye, stop.eye + ahead * distance, body)) continue;
        for (const std::uint32_t frame : {0u, fewest_frames - 1}) {
            const Vec3 at = stop.eye + ahead * (frame == 0 ? 0 : distance);
            tour.keys.push_back({frame, at, at + ahead * look_ahead});
        }
        return;
    }
    for (std::uint32_t turn = 0; turn < 4; ++turn)
        tour.keys.push_back(
            {turn * (fewest_frames - 1) / 3, stop.eye,
             stop.eye + heading(stop.heading_degrees + 30 * static_cast<float>(turn)) * look_ahead});
}

}  // namespace

bool is_spawn_point(std::string_view name) {
    return name == "info_player_start" || name == "info_player_deathmatch" || name == "info_player_dd" ||
           name.starts_with("team_CTF_redspawn") || name.starts_with("team_CTF_bluespawn") ||
           name.starts_with("team_CTF_redplayer") || name.starts_with("team_CTF_blueplayer");
}

bool is_item(std::string_view name) {
    return name.starts_with("item_") || name.starts_with("weapon_") || name.starts_with("ammo_") ||
           name.starts_with("holdable_") || name == "team_CTF_redflag" || name == "team_CTF_blueflag";
}

std::vector<Stop> stops_of(const Bsp& bsp, const FreeSpace& space) {
    std::vector<Stop> stops;
    for (const bool spawns : {true, false}) {
        for (const BspEntity& entity : bsp.entities) {
            if (stops.size() == most_stops) return stops;
            const std::string_view name = entity.value("classname");
            if (!(spawns ? is_spawn_point(name) : is_item(name))) continue;
            const auto origin = triple_in(entity.value("origin"));
            if (!origin) continue;
            const Vec3 above = *origin + Vec3{0, 0, 16};
            const auto floor = space.floor_below(above, 256);
            if (!floor && !spawns) continue;
            Stop stop{{origin->x, origin->y, floor ? *floor + eye_height : origin->z + 26}, 0, spawns};
            const std::string_view angle = entity.value("angle");
            float degrees = 0;
            std::from_chars(angle.data(), angle.data() + angle.size(), degrees);
            if (std::abs(degrees) <= 360) stop.heading_degrees = degrees;
            if (space.clear(stop.eye, body)) stops.push_back(stop);
        }
    }
    return stops;
}

Tour plan_tour(std::span<const Stop> stops, const FreeSpace& space,
               std::span<const std::uint32_t> kind_of_triangle, double most_length) {
    const Ways ways = ways_between(stops, space);
    std::size_t start = stops.size();
    std::pair<std::size_t, std::size_t> most{0, 0};  // Stops in reach, then kinds seen.
    for (std::size_t i = 0; i < stops.size(); ++i) {
        if (!stops[i].is_spawn) continue;
        const std::size_t count = reached(reach_from(i, ways));
        if (count < most.first) continue;
        const std::pair shown{count, kinds_seen(stops[i], space, kind_of_triangle)};
        if (start == stops.size() || shown > most) start = i, most = shown;
    }
    Tour tour;
    const Stop& first = stops[start];
    tour.camera.position = first.eye;
    tour.camera.target = first.eye + heading(first.heading_degrees) * look_ahead;
    Line line;
    for (const std::size_t stop : walk(stops, ways, start, most_length)) line.append(stops[stop].eye);
    if (line.corners().size() < 2 || line.length() < 64) {
        stay(tour, first, space);
        return tour;
    }
    tour.walks = true;
    const auto steps = std::min(most_length, double{line.length()}) / double{units_a_frame};
    Line cut;  // The first most_length units.
    for (const float at : line.corners())
        if (at < most_length) cut.append(line.point(at));
    cut.append(line.point(static_cast<float>(std::min(most_length, double{line.length()}))));
    tour.frames = std::max(fewest_frames, static_cast<std::uint32_t>(steps) + 1);
    for (const float spacing : {192.0f, 96.0f, 48.0f, 24.0f}) {
        tour.keys = keys_along(cut, tour.frames, spacing);
        if (is_clear(tour.keys, tour.frames, space)) return tour;
    }
    tour.keys = key_every_frame(cut, tour.frames);
    return tour;
}

}  // namespace regather::imports
