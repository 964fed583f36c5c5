#include "nodes/output/windows/wall_layout.hpp"

namespace mural {

std::vector<TileWindow> windowsOfTiles(const TileGrid& grid, const TileRegion& region, int width, int height) {
    std::vector<PixelViewport> tiles;
    std::vector<int> numbers;
    for (int row = region.row; row < region.row + region.rows; ++row) {
        for (int column = region.column; column < region.column + region.columns; ++column) {
            tiles.push_back(tileViewport(grid, column, row, width, height));
            numbers.push_back((grid.rows - 1 - row) * grid.columns + column);
        }
    }
    std::vector<TileWindow> windows = placeTiles(tiles, height);
    for (size_t i = 0; i < windows.size(); ++i) {
        windows[i].title = "Mural tile " + std::to_string(numbers[i]);
        windows[i].monitor = numbers[i];
    }
    return windows;
}

} // namespace mural
