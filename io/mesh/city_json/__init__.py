"""CityJSON: the TIN of a terrain as a TINRelief."""
