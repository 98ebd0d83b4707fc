#!/bin/sh
# Build a TIN of each sample: GeoJSON for a GIS, PLY for mesh tools, PNG to look at.
# Usage: sh sample_data/demo.sh FOLDER, with tinsmith on the PATH.
set -eu
samples=$(dirname "$0")
folder=${1:-demo}
mkdir -p "$folder"

# A machine without OpenGL still gets the files; view says what it lacks.
draw() {
  tinsmith view "$folder/$1.ply" -o "$folder/$1.png" --title "$2" --quiet ||
    echo "Without a picture: $1.png"
}

echo "A survey of an invented site:"
tinsmith build "$samples/site_survey.csv" --crs EPSG:32616 --codes \
  -o "$folder/site_survey.geojson" -o "$folder/site_survey.ply"
draw site_survey "Site survey"

echo
echo "The hills around Jacksboro, Tennessee:"
tinsmith build "$samples/jacksboro.tif" \
  -o "$folder/jacksboro.geojson" -o "$folder/jacksboro.ply"
draw jacksboro "Jacksboro, Tennessee"

echo
echo "Ready:"
ls -1 "$(cd "$folder" && pwd)"/*
