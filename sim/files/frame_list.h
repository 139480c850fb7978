// frames.csv: the frames of an export that are whole, with step and time of each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace icloth {

/// A row of the list; its number is that of the frame.
struct ListedFrame {
  std::int64_t step = 0;
  double time = 0;  ///< [s], with the digits of the list
};

/// The path of the list of a folder.
std::string frame_list(const std::string& folder);

/// Begins a list without frames. Throws InputError where it cannot be written.
void begin_frame_list(const std::string& folder);

/// Adds a frame, all or nothing. Throws InputError where it cannot be written.
void add_to_frame_list(const std::string& folder, std::size_t number, const ListedFrame& frame);

/// Writes the list anew. Throws InputError where it cannot be written.
void write_frame_list(const std::string& folder, const std::vector<ListedFrame>& frames);

/// The frames of a list; a last row without an end, which a crash leaves, is none. Throws
/// InputError naming the row, where it is not the list of an export.
std::vector<ListedFrame> read_frame_list(const std::string& folder);

/// The path of a frame without its extension: FOLDER/frame_00012.
std::string numbered_frame(const std::string& folder, std::size_t number);

/// The comment in the file of a frame.
std::string frame_comment(const ListedFrame& frame);

/// The time as the list has it, so that what is made of the list later has the same bits.
double listed_time(double time);

}  // namespace icloth
