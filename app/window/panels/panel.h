// The view that panels have of the program, and the requests that they may make. Each panel is one
// function that draws itself into the current ImGui frame.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "app/session/garment_gauge.h"
#include "app/session/session.h"
#include "app/window/drag.h"
#include "app/window/panels/stage_history.h"
#include "app/window/parameter_edits.h"
#include "render/renderer.h"
#include "sim/scene/intersections.h"
#include "sim/scene/scene_io.h"
#include "sim/scene/world.h"

namespace icloth {

/// A place on the window [logical pixels].
struct Rect {
  float x = 0, y = 0, width = 0, height = 0;
  bool contains(double px, double py) const {
    return px >= x && py >= y && px < x + width && py < y + height;
  }
};

/// The arrangement that the user chose, and the requests of the panels to the viewer.
struct UiState {
  bool panels = true, help = false;
  ViewMode view = ViewMode::shaded;
  std::int64_t chosen_step = -1;  ///< clicked in the stage plot, −1: the newest
  int history_at = -1;            ///< step of the history slider while it is held, else −1
  bool slider_held = false;       ///< the active slider has moved before in this gesture

  bool show_failure = false;   ///< asked for: look at the offending faces
  bool save_session = false;   ///< asked for: write the recording
  std::string open_scene;      ///< asked for: another scene; empty: none
  std::vector<Rect> overlays;  ///< floating panels of this frame: clicks there are theirs
};

/// The parts of the program that panels read and change.
struct PanelContext {
  Session& session;
  const PublishedState& state;
  ParameterEdits& edits;
  const StageHistory& stages;
  const Drag& drag;
  const Scene& scene;
  const World& world;
  const SceneOrigin& origin;
  const StartConflicts& start_conflicts;
  const std::vector<IntersectingFaces>& start_intersections;  ///< the faces of the conflicts
  const std::vector<GarmentState>& garments;                  ///< as they were measured last
  UiState& ui;
  float scale = 1;
};

/// Texts of the status bar that come from the program around the panels.
struct StatusTexts {
  std::string device;       ///< "cpu32, 3 threads"
  std::string upload_path;  ///< "host copy (built without CUDA)"
  double ui_fps = 0;
  std::string note;  ///< last message, empty after a while
  bool note_is_bad = false;
  /// Of the place under the pointer, or of the depth of the hand that holds the cloth; may be
  /// empty.
  std::string pointer;
};

inline constexpr float kPanelWidth = 340, kBarHeight = 52;  ///< at scale 1

/// The number of collisions that the newest step left, or of pairs of faces that cross at the
/// start.
long long penetrations(const PanelContext& context);

/// Draws the column on the left: transport, stage plot, then tabs of parameters and statistics.
void draw_side_panel(PanelContext& context, const Rect& place);
void draw_transport(PanelContext& context);
/// Draws what the loader says about the input of the scene; nothing where it says nothing.
void draw_notes(const PanelContext& context);
/// Draw the clips of bodies with a switch to hold them, and the seams and strains of garments;
/// nothing where the scene has none.
void draw_bodies(PanelContext& context);
void draw_garments(const PanelContext& context);
void draw_stage_plot(PanelContext& context);
void draw_parameters(PanelContext& context);
void draw_statistics(PanelContext& context);
/// Draw one line about the errors of the newest step, and the rows of a table about those of a
/// step.
void draw_estimates_line(const PanelContext& context);
void draw_estimates(const StepReport& report, const Parameters& parameters);
/// Draws hint line and status line along the bottom; the penetration counter is always there.
void draw_status_bar(PanelContext& context, const StatusTexts& texts, const Rect& place);
/// Says why nothing goes on, over the top of the view; draws nothing when all is well.
void draw_failure(PanelContext& context, const Rect& view);
/// Says what the colours of the view mean; nothing where they are those of the fabric.
/// `strain_range`: see Frame.
void draw_legend(PanelContext& context, const Rect& view, double strain_range);
/// Draws the table of keys over the middle of the view.
void draw_help(PanelContext& context, const Rect& view);

}  // namespace icloth
