"""GeoParquet: read by a child process, whole or group of rows after group."""
