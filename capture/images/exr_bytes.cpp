#include "capture/images/exr_bytes.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>

#include <algorithm>

namespace regather::capture {
namespace {

/// A stream of OpenEXR into memory.
class Bytes : public Imf::OStream {
public:
    Bytes() : OStream("memory") {}
    void write(const char data[], int count) override {
        const auto size = static_cast<std::size_t>(count);
        bytes_.resize(std::max(bytes_.size(), at_ + size));
        bytes_.replace(at_, size, data, size);
        at_ += size;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t place) override { at_ = place; }
    std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

}  // namespace

std::string exr_bytes(std::uint32_t width, std::uint32_t height, std::span<const Channel> channels) {
    Imf::Header header(static_cast<int>(width), static_cast<int>(height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer values;
    for (const Channel& channel : channels) {
        header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
        // OpenEXR reads through a pointer that it could write to.
        char* first = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
        values.insert(channel.name, Imf::Slice(Imf::FLOAT, first, sizeof(float), sizeof(float) * width));
    }
    Bytes bytes;
    {
        Imf::OutputFile file(bytes, header, 0);  // no threads; the destructor writes the table of offsets
        file.setFrameBuffer(values);
        file.writePixels(static_cast<int>(height));
    }
    return bytes.take();
}

}  // namespace regather::capture
