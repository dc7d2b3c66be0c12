#include "parallel/round_bytes.h"

#include <bit>
#include <cstring>
#include <type_traits>

#include "core/error.h"
#include "core/math/random.h"

namespace lightwalk {
namespace {

static_assert(std::endian::native == std::endian::little);

// Each kind of thing lists its fields once, for writing, reading and hashing alike.
template <class Archive>
void fields(Archive& archive, Vec3& v) {
    archive(v.x, v.y, v.z);
}
template <class Archive>
void fields(Archive& archive, Rgb& c) {
    archive(c.r, c.g, c.b);
}
template <class Archive>
void fields(Archive& archive, AmbientPoint& p) {
    AmbientQuery& q = p.query;
    Medium& m = p.medium;
    archive(q.position, q.normal, q.shading_normal, q.level, q.weight, m.extinction, m.albedo,
            m.eccentricity, p.distance, p.path_length, p.limit, p.ray_level, p.target, p.history,
            p.far_side);
}
template <class Archive>
void fields(Archive& archive, AmbientRecord& r) {
    archive(r.position[0], r.position[1], r.position[2], r.normal, r.axis, r.radius[0], r.radius[1],
            r.translation[0], r.translation[1], r.rotation[0], r.rotation[1], r.value, r.weight,
            r.corral, r.level);
}
template <class Archive>
void fields(Archive& archive, NewAmbientRecord& find) {
    archive(find.point, find.record);
}
template <class Archive, class T>
void fields(Archive& archive, std::vector<T>& list) {
    archive.list(list);
}
template <class Archive>
void fields(Archive& archive, RoundValue& value) {
    archive(value.new_records, value.record);
}

/// Visits fields recursively, down to numbers, which Derived handles (CRTP).
template <class Derived>
class Archive {
  public:
    template <class... Fields>
    void operator()(Fields&... all) {
        (one(all), ...);
    }

  private:
    template <class T>
    void one(T& value) {
        if constexpr (std::is_arithmetic_v<T>)
            static_cast<Derived*>(this)->number(value);
        else
            fields(static_cast<Derived&>(*this), value);
    }
};

class Writer final : public Archive<Writer> {
  public:
    template <class T>
    void number(const T& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class T>
    void list(std::vector<T>& values) {
        number(static_cast<std::uint64_t>(values.size()));
        for (T& value : values) (*this)(value);
    }
    std::string bytes;
};

class Reader final : public Archive<Reader> {
  public:
    explicit Reader(const std::string& bytes) : bytes_(bytes) {}
    template <class T>
    void number(T& value) {
        if (bytes_.size() - at_ < sizeof value) fail();
        std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
    }
    void number(bool& value) {
        std::uint8_t byte = 0;
        number(byte);
        value = byte != 0;
    }
    template <class T>
    void list(std::vector<T>& values) {
        std::uint64_t count = 0;
        number(count);
        if (count > bytes_.size() - at_) fail();  // each element takes at least a byte
        for (std::uint64_t i = 0; i < count; ++i) (*this)(values.emplace_back());
    }
    void end() const {
        if (at_ != bytes_.size()) fail();
    }

  private:
    [[noreturn]] static void fail() {
        throw InputError("another rank's ambient values cannot be read");
    }
    const std::string& bytes_;
    std::size_t at_ = 0;
};

class Hasher final : public Archive<Hasher> {
  public:
    template <class T>
    void number(const T& value) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof value);
        hash = mix_bits(hash ^ bits);
    }
    std::uint64_t hash = 0;
};

template <class T>
std::string encode(const std::vector<T>& values) {
    Writer writer;
    writer.list(const_cast<std::vector<T>&>(values));  // the writer only reads them
    return std::move(writer.bytes);
}

}  // namespace

std::string encode_points(const std::vector<AmbientPoint>& points) {
    return encode(points);
}

void decode_points(const std::string& bytes, std::vector<AmbientPoint>& points) {
    Reader reader(bytes);
    reader.list(points);
    reader.end();
}

std::string encode_values(const std::vector<RoundValue>& values) {
    return encode(values);
}

std::vector<RoundValue> decode_values(const std::string& bytes) {
    std::vector<RoundValue> values;
    Reader reader(bytes);
    reader.list(values);
    reader.end();
    return values;
}

std::uint64_t hash_of(const AmbientPoint& point) {
    AmbientPoint copy = point;
    Hasher hasher;
    fields(hasher, copy);
    return hasher.hash;
}

}  // namespace lightwalk
